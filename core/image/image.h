// SPDX-License-Identifier: MIT
// Pictures as plain values, rows top to bottom, channels interleaved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra {

template <class T>
struct BasicImage {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<T> data;  // width * height * channels

    BasicImage() = default;
    BasicImage(int w, int h, int c, T fill = T{})
        : width(w), height(h), channels(c), data(std::size_t(w) * std::size_t(h) * std::size_t(c), fill) {}

    T* at(int x, int y) { return data.data() + (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels); }
    const T* at(int x, int y) const { return data.data() + (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels); }
};

using Image8 = BasicImage<std::uint8_t>;    // sRGB encoded
using Image16 = BasicImage<std::uint16_t>;  // sRGB encoded, native endian
using ImageF = BasicImage<float>;           // linear

}  // namespace penumbra
