// SPDX-License-Identifier: MIT
// Little endian numbers to and from bytes, on any machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/image/codec.h"

namespace penumbra {

template <class T>
T read_little(std::span<const std::uint8_t> bytes, std::size_t at) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        value = T(value | T(T(bytes[at + i]) << (8 * i)));
    }
    return value;
}

template <class T>
void put_little(std::uint8_t* to, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        to[i] = std::uint8_t(value >> (8 * i));
    }
}

template <class T>
void append_little(Bytes& file, T value) {
    file.resize(file.size() + sizeof(T));
    put_little(file.data() + file.size() - sizeof(T), value);
}

}  // namespace penumbra
