// SPDX-License-Identifier: MIT
// The scene's outline as the method `exact` reads it (glsl/exact.h): pieces that do not cross, in pixels of the view.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "core/plan/dark_region.h"
#include "core/plan/surfaces.h"
#include "core/scene/scene.h"

namespace penumbra {

struct PackedOutline {
    std::vector<glm::vec4> entries;         // of the one list that holds all pieces
    std::vector<glm::vec4> lights_of;       // for each texel of entries: radiance of its piece, and which piece it is
    std::array<int, 4> counts{};            // by kind: straight pieces, discs, arcs, ellipses
    std::array<int, 4> lights{};            // how many of them shine; they come first of their kind
    std::size_t pieces = 0;
    std::size_t emitting = 0;
    bool fits = true;                       // false: too many pieces
    double smallest_light = 0;              // px: extent of the smallest body that emits; 0: none does
    double smallest_body = 0;               // px: extent of the smallest of all
    double mean_intervals = 0;              // of direction that a point tells apart, over a few points; when asked for
    std::vector<DarkRegion> dark_regions;   // closed off from all light
    Surfaces surfaces;                      // empty unless they reflect, or emission changes along them
    std::size_t bytes() const { return 16 * (entries.size() + lights_of.size()); }
};

// Emission is divided by `radiance_scale`. Corners that two pieces share stay equal to the last bit. `survey` asks for
// `mean_intervals`, which tells how dear the scene is. Expects at most `most_pieces`, else `fits` is false.
// With `reflecting`, pieces with an albedo shine as well; then, or where emission changes along a piece, `surfaces` is filled.
PackedOutline pack_outline(const Scene& scene, double radiance_scale, bool survey, std::size_t most_pieces, bool reflecting = false);

// Two texels a node, one node more than `nodes`: the integral of the sky's radiance from angle 0 on; its radiance and, in a, a
// number of the part between two of its steps. `moment` 1 and 2: the integral of radiance times the cosine, the sine of its angle.
std::vector<glm::vec4> sky_nodes(const Sky& sky, int nodes, double radiance_scale, int moment = 0);

}  // namespace penumbra
