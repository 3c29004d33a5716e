// SPDX-License-Identifier: MIT
// The distance pass once more, in double precision and in world units: what the shaders are held against.
#pragma once

#include <glm/vec2.hpp>

#include <vector>

#include "core/scene/scene.h"

namespace penumbra::test {

// Exact signed distance to a shape's outline, negative inside. Not for bitmaps.
double exact_distance(const Shape& shape, Point p);

struct FieldValue {
    double distance = 0;
    int shape = -1;  // topmost that covers the point, else the nearest
};
// Of shapes that are no bitmaps. `far` is the distance where there is no shape.
FieldValue exact_field(const std::vector<Shape>& shapes, Point p, double far);

// Two shapes are about equally near (or an outline is about here): single precision may decide either way.
bool is_tie(const std::vector<Shape>& shapes, Point p, double within);

}  // namespace penumbra::test
