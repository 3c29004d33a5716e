// SPDX-License-Identifier: MIT
// Radiance cascades once more, in double precision on the CPU: the same plan, its own march over exact distances.
#pragma once

#include <vector>

#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace penumbra::test {

// One cascade's texels as the device stores them: radiance, and 1 where the probe is in free space.
struct TwinCascade {
    glm::ivec2 size{0};
    std::vector<Colour> radiance;
    std::vector<double> weight;
    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(size.x) + std::size_t(x); }
};

// Farthest last. Of shapes that are no bitmaps, in a view of one unit a pixel at the origin.
std::vector<TwinCascade> twin_cascades(const Scene& scene, const Plan& plan);

// The mean radiance of each pixel, row by row, from cascade 0.
std::vector<Colour> twin_resolve(const Plan& plan, const TwinCascade& nearest);

}  // namespace penumbra::test
