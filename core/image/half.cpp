// SPDX-License-Identifier: MIT
#include "core/image/half.h"

#include <bit>
#include <cmath>

namespace penumbra {

namespace {

constexpr int kBiasDifference = 127 - 15;
constexpr std::uint16_t kLargestBits = 0x7bff;
constexpr std::uint16_t kQuietNan = 0x7e00;

}  // namespace

std::uint16_t to_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const auto sign = std::uint16_t((bits >> 16) & 0x8000u);
    const std::uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) {
        return std::uint16_t(sign | kQuietNan);
    }
    if (std::bit_cast<float>(magnitude) >= kLargestHalf) {
        return std::uint16_t(sign | kLargestBits);
    }
    const int exponent = int(magnitude >> 23) - kBiasDifference;
    if (exponent < -10) {
        return sign;  // less than half of the smallest half
    }
    // With its leading one; subnormal halves are shifted further, and lose it.
    const std::uint32_t fraction = (magnitude & 0x7fffffu) | 0x800000u;
    const int shift = exponent >= 1 ? 13 : 14 - exponent;
    const std::uint32_t cut = fraction >> shift;
    const std::uint32_t rest = fraction & ((1u << shift) - 1);
    const std::uint32_t middle = 1u << (shift - 1);
    std::uint32_t half = exponent >= 1 ? (std::uint32_t(exponent - 1) << 10) + cut : cut;
    // A carry out of the fraction goes into the exponent, which is right.
    if (rest > middle || (rest == middle && (half & 1u) != 0)) {
        ++half;
    }
    return std::uint16_t(sign | half);
}

float from_half(std::uint16_t half) {
    const int exponent = (half >> 10) & 31;
    const int fraction = half & 1023;
    float magnitude = 0;
    if (exponent == 31) {
        magnitude = fraction == 0 ? INFINITY : NAN;
    } else if (exponent == 0) {
        magnitude = std::ldexp(float(fraction), -24);
    } else {
        magnitude = std::ldexp(float(1024 + fraction), exponent - 25);
    }
    return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

}  // namespace penumbra
