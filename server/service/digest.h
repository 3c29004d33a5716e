// SPDX-License-Identifier: MIT
// SHA-256: names for contents that clients choose, so that none of them can make two contents meet under one name.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace penumbra {

// 64 hexadecimal digits. Each part counts with its length: {"ab", "c"} is not {"a", "bc"}.
std::string sha256(std::initializer_list<std::string_view> parts);

}  // namespace penumbra
