// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "server/service/render_service.h"

namespace penumbra {

// One line on stderr for each problem, with the file's name first, as a compiler does.
void complain_about_scene(const std::string& path, const std::vector<LocatedProblem>& problems,
                          std::size_t left_out);

}  // namespace penumbra
