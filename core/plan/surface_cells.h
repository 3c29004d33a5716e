// SPDX-License-Identifier: MIT
// What surfaces shine with, as rays that are sampled find it: by the cell in which they end (docs/methods/bounces.md).
#pragma once

#include <cstdint>
#include <vector>

#include <glm/ext/vector_uint2.hpp>
#include <glm/vec4.hpp>

#include "core/plan/plan.h"
#include "core/plan/surfaces.h"

namespace penumbra {

// As glsl/surface_records.h lays them out.
struct SurfaceCells {
    std::vector<glm::uvec2> heads;
    std::vector<glm::vec4> chords;
};

// `elements`: kExactElementTexels a piece's element, as the reflection wrote them.
SurfaceCells surface_cells(const Surfaces& surfaces, const std::vector<glm::vec4>& elements, const GridPlan& grid);

}  // namespace penumbra
