// SPDX-License-Identifier: MIT
// What the method `exact` does for a scene: its outline, how directions are divided, where it solves and where it
// interpolates (docs/methods/exact-gpu.md).
#pragma once

#include <cstddef>
#include <vector>

#include <glm/ext/vector_int2.hpp>

#include "core/plan/pack_outline.h"
#include "core/scene/scene.h"

namespace penumbra {

// A point of the method's time/error curve.
struct ExactSettings {
    double tolerance = 0;       // of the interpolation, relative to the light there and a share of the mean
    int kink_cell = 1;          // px: cells larger than this are split where a shadow's edge may cross them
    bool strict_dark = false;   // pixels between light and dark are always solved
    int largest_cell = 8;       // px: larger ones are always split
};
// Extents of the smallest light (0 where only the sky shines) and of the smallest body, px.
ExactSettings exact_settings(Quality quality, double smallest_light, double smallest_body);

struct ExactPlan {
    bool used = false;
    PackedOutline outline;
    ExactSettings settings;
    int sectors = 0;            // of direction, around the circle
    double first_axis = 0;      // angle of the first sector's axis, radians: no common angle lies on a border
    int coarse_tile = 0;        // px: lists of such tiles are made first; 0: there are few pieces
    int band_rows = 0;          // pixels: the canvas is solved this many rows at a time, a multiple of the tile
    int sky_nodes = 0;          // 0: a constant sky, or none
    bool surfaces = false;      // pieces shine differently from place to place
    bool moments = false;       // means of radiance times direction are asked for as well
    int bounces = 0;            // 0: surfaces do not reflect
    double converged = 0;       // ends before, once nothing changes by more than this share of the brightest; 0: does not
};

ExactPlan plan_exact(const Scene& scene, PackedOutline outline, glm::ivec2 canvas, bool software);

// Of the textures that one band of a canvas takes.
std::size_t exact_bytes(const ExactPlan& plan, glm::ivec2 canvas);

// How many points of a tile the level of this number adds at most: level 0 is the corners of the largest cells,
// each further level halves the cells, the last are pixels.
std::size_t exact_level_points(int level);

}  // namespace penumbra
