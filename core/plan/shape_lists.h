// SPDX-License-Identifier: MIT
// Which shapes can decide the distance field in which tile of the grid: the distance pass asks only those. Pure arithmetic.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/ext/vector_int2.hpp>

#include "core/plan/pack.h"
#include "core/plan/plan.h"

namespace penumbra {

// In each tile, the shapes that can be the nearest of one of its pixels, or cover it, in the scene's order: the same
// distances and the same materials come of these as of all. Where distances beyond a reach are not asked for, only shapes that can be
// nearer than that: the same distances come of them up to the reach on both sides of an outline, what is farther (or deeper) comes out
// as at least as far, and materials are the same where distances are.
struct ShapeLists {
    glm::ivec2 tiles{0};             // along x and y, kDistanceTile pixels a side; 0: no lists
    int slices = 1;                  // a list that one invocation cannot walk is walked in parts
    std::vector<glm::ivec2> ranges;  // slice by slice, row by row: first and end in `shapes`
    std::vector<int> shapes;
    double mean_length = 0;          // shapes a pixel asks
    std::size_t tile_count() const { return static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y); }
};

// Tiles outside the rows from `first_row` to `end_row` of the grid get none (0: to its end).
ShapeLists list_shapes(const PackedScene& scene, const GridPlan& grid, int first_row = 0, int end_row = 0, double reach_px = kUnlimitedReach);
// As the plan says.
inline ShapeLists list_shapes(const PackedScene& scene, const Plan& plan) {
    return list_shapes(scene, plan.grid, plan.first_distance_row, plan.end_distance_row, plan.distance_reach_px);
}

// The work that the lists save, for the statistics.
SkippedWork saved_by_lists(const ShapeLists& lists, const PackedScene& scene, const GridPlan& grid, double reach_px = kUnlimitedReach);

}  // namespace penumbra
