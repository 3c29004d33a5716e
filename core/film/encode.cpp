// SPDX-License-Identifier: MIT
#include "core/film/encode.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

double srgb_encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double srgb_decoded(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

PixelNoise pixel_noise(int x, int y) {
    std::uint32_t v[3] = {std::uint32_t(x), std::uint32_t(y), 0};
    for (std::uint32_t& n : v) n = n * 1664525u + 1013904223u;
    const auto mix = [&] {
        v[0] += v[1] * v[2];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
    };
    mix();
    for (std::uint32_t& n : v) n ^= n >> 16;
    mix();
    PixelNoise noise{};
    for (int c = 0; c < 3; ++c) {
        noise.first[c] = double(v[c] >> 16) / 65536;
        noise.second[c] = double(v[c] & 0xffffu) / 65536;
    }
    return noise;
}

int code_of(double value, int largest) {
    return std::clamp(int(std::floor(value * largest + 0.5)), 0, largest);
}

int dithered_code_of(double value, int largest, double first, double second) {
    const double scaled = value * largest;
    const bool at_end = scaled < 0.5 || scaled > largest - 0.5;
    return std::clamp(int(std::floor(at_end ? scaled + first : scaled + 0.5 + first - second)), 0, largest);
}

}  // namespace penumbra
