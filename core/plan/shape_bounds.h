// SPDX-License-Identifier: MIT
// Bounds on what the distance shader may return for a shape, in double precision, its rounding included.
#pragma once

#include <cstddef>

#include <glm/vec2.hpp>

#include "core/plan/pack.h"

namespace penumbra {

struct DistanceBounds {
    double low = 0;
    double high = 0;
};

// Of the signed distance (px) of shape `index` at any point within `reach` of `p`. A shape surely farther than `enough` may
// be judged by its box. Infinite where nothing is known.
DistanceBounds distance_bounds(const PackedScene& scene, std::size_t index, glm::dvec2 p, double reach, double enough);

}  // namespace penumbra
