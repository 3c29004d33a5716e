// SPDX-License-Identifier: MIT
// Deflate for what is no picture: answers to clients, and scenes in addresses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace penumbra {

// A whole gzip file (RFC 1952); the same bytes for the same text.
std::string gzip(std::string_view text);

// Raw deflate (RFC 1951), and back: nothing when it is none, or more than `most_bytes`.
std::string deflate_raw(std::string_view text);
std::optional<std::string> inflate_raw(std::string_view bytes, std::size_t most_bytes);

// CRC-32 of gzip, PNG and ZIP.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace penumbra
