// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace penumbra {

std::string version();  // "0.1.0"

}  // namespace penumbra
