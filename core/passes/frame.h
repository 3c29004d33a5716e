// SPDX-License-Identifier: MIT
// What one render passes from step to step.
#pragma once

#include <cstddef>

#include "core/gl/handles.h"

namespace penumbra {

// Signed distance to the nearest shape, and which shape, on the grid of the plan.
struct DistanceField {
    gl::Texture2D distance;  // r32f, px
    gl::Texture2D material;  // r32i, shape index or -1
};

// How much one dispatch may cover before the pass is cut into bands: about 10 ms on llvmpipe.
struct Slicing {
    std::size_t distance_iterations = 0;  // pixels times shapes
    std::size_t rays = 0;
    std::size_t pixels = 0;
};

// What a pass reports of its run.
struct PassWork {
    int dispatches = 0;
    std::size_t rays = 0;
    std::size_t bytes = 0;  // written to textures
};

}  // namespace penumbra
