// SPDX-License-Identifier: MIT
#include "core/film/tone_lut.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>

#include "core/image/byte_order.h"

namespace penumbra {
namespace {

// Offsets in the file ("DDS_HEADER" and "DDS_HEADER_DXT10" of the DirectX documentation).
constexpr std::size_t kHeight = 12, kWidth = 16, kDepth = 24, kFourCc = 84, kDxgiFormat = 128, kTexels = 148;
constexpr std::uint32_t kMagic = 0x20534444;  // "DDS "
constexpr std::uint32_t kDx10 = 0x30315844;   // "DX10"
constexpr std::uint32_t kRgba32f = 2, kRgb9e5 = 67;
constexpr int kMostSide = 128;

glm::vec3 shared_exponent(std::uint32_t bits) {
    const int exponent = int(bits >> 27) - 15 - 9;
    const auto channel = [&](int shift) { return float(std::ldexp(double((bits >> shift) & 511u), exponent)); };
    return {channel(0), channel(9), channel(18)};
}

}  // namespace

std::variant<ToneLut, std::string> decode_tone_lut(std::span<const std::uint8_t> bytes) {
    const auto number = [&](std::size_t at) { return read_little<std::uint32_t>(bytes, at); };
    if (bytes.size() < kTexels || number(0) != kMagic || number(kFourCc) != kDx10) return "is no DDS file with a DX10 header";
    const std::uint32_t side = number(kWidth), format = number(kDxgiFormat);
    if (side < 2 || side > std::uint32_t(kMostSide) || number(kHeight) != side || number(kDepth) != side)
        return "must be a cube of 2 to " + std::to_string(kMostSide) + " texels on a side";
    if (format != kRgba32f && format != kRgb9e5) return "must hold R9G9B9E5 or RGBA32F, is of DXGI format " + std::to_string(format);
    const std::size_t texel = format == kRgba32f ? 16 : 4, count = std::size_t(side) * side * side;
    if (bytes.size() - kTexels < count * texel) return "is cut off";
    ToneLut lut{int(side), std::vector<glm::vec3>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = kTexels + i * texel;
        if (format == kRgb9e5) {
            lut.texels[i] = shared_exponent(number(at));
            continue;
        }
        for (int c = 0; c < 3; ++c) lut.texels[i][c] = std::bit_cast<float>(number(at + 4 * std::size_t(c)));
    }
    for (const glm::vec3& colour : lut.texels)
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(colour[c])) return "holds what is no number";
    return lut;
}

Colour ToneLut::at(const Colour& stimulus) const {
    const glm::dvec3 place = glm::clamp(stimulus, 0.0, 1.0) * double(size - 1);
    const glm::ivec3 low = glm::min(glm::ivec3(place), glm::ivec3(size - 2));
    const glm::dvec3 f = place - glm::dvec3(low);
    Colour sum(0);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::ivec3 at = low + step;
        double weight = 1;
        for (int c = 0; c < 3; ++c) weight *= step[c] == 1 ? f[c] : 1 - f[c];
        sum += weight * glm::dvec3(texels[std::size_t((at.z * size + at.y) * size + at.x)]);
    }
    return sum;
}

}  // namespace penumbra
