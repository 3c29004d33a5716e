// SPDX-License-Identifier: MIT
#include "server/json/base64.h"

#include <array>

namespace penumbra {

namespace {

constexpr std::uint8_t kBad = 0xff;

constexpr std::array<std::uint8_t, 256> make_table() {
    constexpr std::string_view kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> table{};
    table.fill(kBad);
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
        table[static_cast<unsigned char>(kAlphabet[i])] = std::uint8_t(i);
    }
    return table;
}

constexpr std::array<std::uint8_t, 256> kTable = make_table();

}  // namespace

Base64 decode_base64(std::string_view text) {
    Base64 result;
    std::size_t padding = 0;
    while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') {
        ++padding;
    }
    const std::size_t letters = text.size() - padding;
    result.bytes.reserve(letters / 4 * 3 + 2);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < letters; ++i) {
        const std::uint8_t value = kTable[static_cast<unsigned char>(text[i])];
        if (value == kBad) {
            result.bad_at = i;
            return result;
        }
        group = group << 6 | value;
        if (i % 4 == 3) {
            result.bytes.push_back(std::uint8_t(group >> 16));
            result.bytes.push_back(std::uint8_t(group >> 8));
            result.bytes.push_back(std::uint8_t(group));
            group = 0;
        }
    }
    const std::size_t rest = letters % 4;
    const std::size_t needed = rest == 0 ? 0 : 4 - rest;
    const bool stray_bits = (rest == 2 && (group & 0xfu)) || (rest == 3 && (group & 0x3u));
    if (rest == 1 || padding != needed || stray_bits) {
        result.bad_at = stray_bits ? letters - 1 : letters;
        return result;
    }
    if (rest == 2) {
        result.bytes.push_back(std::uint8_t(group >> 4));
    } else if (rest == 3) {
        result.bytes.push_back(std::uint8_t(group >> 10));
        result.bytes.push_back(std::uint8_t(group >> 2));
    }
    result.good = true;
    return result;
}

}  // namespace penumbra
