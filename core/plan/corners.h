// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>

#include "core/plan/pack.h"

namespace penumbra {

// Gives corners that are equal but for rounding the same single-precision coordinates.
class Corners {
public:
    explicit Corners(const PixelFrame& frame) : frame_(frame) {}

    glm::vec2 at(Point p) {
        const glm::dvec2 px = frame_.point(p);
        const std::int64_t x = cell(px.x), y = cell(px.y);
        for (std::int64_t dy = -1; dy <= 1; ++dy) {
            for (std::int64_t dx = -1; dx <= 1; ++dx) {
                const auto found = seen_.find(key(x + dx, y + dy));
                if (found == seen_.end()) continue;
                for (const glm::dvec2 other : found->second)
                    if (std::abs(other.x - px.x) < kSame && std::abs(other.y - px.y) < kSame) return glm::vec2(other);
            }
        }
        seen_[key(x, y)].push_back(px);
        return glm::vec2(px);
    }

private:
    static constexpr double kSame = 1e-6;  // px
    static std::int64_t cell(double v) { return static_cast<std::int64_t>(std::floor(v * 4096)); }
    static std::uint64_t key(std::int64_t x, std::int64_t y) {
        return static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(y);
    }

    const PixelFrame& frame_;
    std::unordered_map<std::uint64_t, std::vector<glm::dvec2>> seen_;
};

}  // namespace penumbra
