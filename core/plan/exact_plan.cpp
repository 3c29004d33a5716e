// SPDX-License-Identifier: MIT
#include "core/plan/exact_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "glsl/exact.h"

namespace penumbra {

ExactSettings exact_settings(Quality quality, double smallest_light, double smallest_body) {
    // Points of the measured front (docs/benchmarks.md). The smaller a light, the harder the edges of its shadows and the
    // thinner its beams, which a cell must not step over.
    const auto cell = [&](double lights) {
        int px = 1;
        while (px < glsl::kExactCell && 2 * px <= lights * smallest_light) px *= 2;
        return smallest_light > 0 ? px : glsl::kExactCell;
    };
    // The shadow of something smaller than a cell could fall between the corners, which then all see the whole light.
    int largest = glsl::kExactCell;
    while (smallest_light > 0 && largest > 1 && largest > smallest_body) largest /= 2;
    switch (quality) {
        case Quality::draft: return {.tolerance = 6e-2, .kink_cell = cell(2), .strict_dark = false, .largest_cell = largest};
        case Quality::standard: return {.tolerance = 1.2e-2, .kink_cell = cell(1), .strict_dark = true, .largest_cell = largest};
        case Quality::high: return {.tolerance = 2e-3, .kink_cell = std::min(cell(0.5), 4), .strict_dark = true, .largest_cell = largest};
    }
    return {};
}

ExactPlan plan_exact(const Scene& scene, PackedOutline outline, glm::ivec2 canvas, bool software) {
    ExactPlan plan;
    plan.used = true;
    plan.settings = exact_settings(scene.render.quality, outline.smallest_light, outline.smallest_body);
    // A sector's list is asked once for each of its edges: more pieces want narrower sectors.
    const std::size_t pieces = outline.pieces;
    plan.sectors = pieces <= 4 ? 8 : pieces <= 24 ? 16 : pieces <= 400 ? 32 : 64;
    // What surfaces shine with changes within a sector; means over narrow ones are right.
    if (!outline.surfaces.pieces.empty()) plan.sectors = std::max(plan.sectors, scene.render.quality == Quality::high ? 64 : 32);
    plan.first_axis = 0.0927;
    plan.coarse_tile = pieces > 48 ? 4 * glsl::kExactTile : 0;
    plan.sky_nodes = scene.sky.gradient.empty() ? 0 : 2048;
    // Lists of a crowded scene are long, and those of a band must fit into 128 MiB.
    const int most_pixels = (software ? 1 << 21 : 1 << 23) / (pieces > 400 ? 4 : 1);
    const int rows = std::max(most_pixels / std::max(canvas.x, 1), 1);
    const int unit = plan.coarse_tile > 0 ? plan.coarse_tile : glsl::kExactTile;
    plan.band_rows = std::max(rows / unit, 1) * unit;
    plan.surfaces = !outline.surfaces.pieces.empty();
    plan.outline = std::move(outline);
    return plan;
}

std::size_t exact_bytes(const ExactPlan& plan, glm::ivec2 canvas) {
    const auto along = [](int pixels) { return static_cast<std::size_t>((pixels + glsl::kExactTile - 1) / glsl::kExactTile * glsl::kExactTile + 1); };
    // Value and two slopes, whether a point is asked for, and the size of its cell.
    return along(canvas.x) * along(std::min(plan.band_rows, canvas.y)) * (3 * 16 + 4 + 4);
}

std::size_t exact_level_points(int level) {
    const auto all = [](int of) {
        const auto side = static_cast<std::size_t>(1 << of) + 1;
        return side * side;
    };
    const int first = 1;  // the largest cells halve the tile
    return level == 0 ? all(first) : all(first + level) - all(first + level - 1);
}

}  // namespace penumbra
