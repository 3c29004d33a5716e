// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace penumbra::gl {

// How many iterations an invocation's loops may make before this driver ends them; 0 when it let 200,000 pass.
// Needs the current context.
int measure_loop_limit(const std::string& shader_dir = {});

}  // namespace penumbra::gl
