// SPDX-License-Identifier: MIT
// Surfaces that reflect, cut into elements whose light is solved for (docs/methods/bounces.md). Pixels of the view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/ext/vector_int2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "core/scene/scene.h"

namespace penumbra {

struct Surfaces {
    // By piece, as glsl/exact.h lays them out.
    std::vector<glm::vec4> pieces;
    std::vector<glm::vec4> materials;
    // By element of a piece that reflects, in no order: place just off the surface and outward normal.
    struct Node {
        glm::vec4 place;
        glm::vec2 extent;  // the element as a vector, px
        std::uint32_t element;
    };
    std::vector<Node> nodes;
    // All that can be seen, as short straight pieces: a ray's end finds the element nearest to it (core/plan/surface_cells.h).
    struct Chord {
        glm::vec4 ends;  // px; free space on the right of the way from a to b, y down
        std::uint32_t element;
    };
    std::vector<Chord> chords;
    std::size_t elements = 0;  // room for elements: those of all pieces, and one more each
};

// A course along which elements lie. `at` and `normal` (outward, any length) by the course from 0 to 1.
struct SurfaceCourse {
    double length = 0;       // px
    double start_angle = 0;  // in the piece's own frame; curved pieces only
    double sweep = 0;        // 0: straight
    bool whole = false;      // a closed curve
};

// Elements of a course: about `size` px in the middle, shorter towards the ends, where the light of a corner bends.
int element_count(const SurfaceCourse& course, double size);
// Where element `index` starts, 0 to 1.
double element_start(int index, int count, bool whole);

// px, in the middle of a long piece.
double element_size(Quality quality);

// Jobs of four nodes of one tile each; the last of a tile's are repeated. `origin`: px, of the first tile.
struct SurfaceJobs {
    std::vector<std::uint32_t> tiles;  // by job
    std::vector<glm::vec4> nodes;      // eight texels a job (glsl/exact.h)
};
SurfaceJobs surface_jobs(const Surfaces& surfaces, glm::ivec2 origin, glm::ivec2 tiles, int tile_px);

}  // namespace penumbra
