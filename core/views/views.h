// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/ext/vector_int2.hpp>

#include "core/image/image.h"

namespace penumbra {

// What the views look at: a value for each pixel of the canvas, row by row.
struct ViewField {
    glm::ivec2 size{0};
    std::vector<float> distance;  // px, negative inside
};

// Warm inside, cold outside, darker with every contour; the outline is white. The legend tells how far contours stand apart.
Image8 draw_distance(const ViewField& field);

// Which way each pixel's nearest outline lies: the gradient of the distance, away from it, as a hue; solid pixels paler.
Image8 draw_normals(const ViewField& field);

// How many shapes each tile of `tile` pixels asks for its distances; black where none is near enough to matter.
Image8 draw_tiles(const ViewField& field, const std::vector<int>& counts, glm::ivec2 tiles, glm::ivec2 border, int tile);

}  // namespace penumbra
