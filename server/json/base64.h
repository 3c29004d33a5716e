// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace penumbra {

struct Base64 {
    std::vector<std::uint8_t> bytes;
    bool good = false;
    std::size_t bad_at = 0;  // the first character that cannot be, when not good
};

// RFC 4648, strictly: the standard alphabet, padded, no white space, no stray bits in the last
// group.
Base64 decode_base64(std::string_view text);

}  // namespace penumbra
