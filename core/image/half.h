// SPDX-License-Identifier: MIT
// Half floats (IEEE 754 binary16), to the nearest and to even between two.
#pragma once

#include <cstdint>

namespace penumbra {

constexpr float kLargestHalf = 65504.0f;

// What is too large becomes the largest finite half of its sign; NaN stays NaN.
std::uint16_t to_half(float value);
float from_half(std::uint16_t half);

}  // namespace penumbra
