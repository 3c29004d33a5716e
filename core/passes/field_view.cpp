// SPDX-License-Identifier: MIT
#include "core/passes/field_view.h"

#include <cstddef>
#include <vector>

#include "core/views/views.h"
#include "glsl/distance.h"

namespace penumbra {

Image8 draw_field(const Plan& plan, const Scene& scene, const DistanceField& field, const ShapeLists& lists) {
    ViewField seen{plan.shown.size, {}};
    const glm::ivec2 border = plan.grid.border + plan.shown.first;
    const bool empty = plan.shape_slices.empty();
    std::vector<float> grid;
    if (!empty) {
        grid.resize(static_cast<std::size_t>(plan.grid.size.x) * static_cast<std::size_t>(plan.grid.size.y));
        field.distance.read(GL_RED, GL_FLOAT, grid.data());
    }
    for (int y = 0; y < seen.size.y; ++y)
        for (int x = 0; x < seen.size.x; ++x) {
            const glm::ivec2 at = glm::ivec2(x, y) + border;
            const auto i = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(plan.grid.size.x) + static_cast<std::size_t>(at.x);
            seen.distance.push_back(empty ? static_cast<float>(plan.grid.diagonal_px) : grid[i]);
        }
    if (scene.render.view == "distance") return draw_distance(seen);
    if (scene.render.view == "normals") return draw_normals(seen);
    // Without lists every tile asks every shape.
    const int side = glsl::kDistanceTile;
    glm::ivec2 tiles = lists.tiles;
    std::vector<int> counts(lists.tile_count(), 0);
    for (std::size_t i = 0; i < lists.ranges.size(); ++i) counts[i % counts.size()] += lists.ranges[i].y - lists.ranges[i].x;
    if (tiles.x == 0) {
        tiles = (plan.grid.size + side - 1) / side;
        counts.assign(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y), static_cast<int>(scene.shapes.size()));
    }
    return draw_tiles(seen, counts, tiles, border, side);
}

}  // namespace penumbra
