// SPDX-License-Identifier: MIT
// How much there is to be seen: a look round from a few points.
#pragma once

#include <vector>

#include "core/reference/boundary.h"
#include "core/scene/scene.h"

namespace penumbra {

// Intervals of direction that a point of the view tells apart, the mean over 6 x 6 points. `shining` (by piece of the boundary;
// null: all of them, and what lies beyond as well) tells which pieces send light: what hides none of it is not told apart.
double survey_intervals(const Scene& scene, const reference::Boundary& boundary, const std::vector<char>* shining);

}  // namespace penumbra
