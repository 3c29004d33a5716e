// SPDX-License-Identifier: MIT
// The scene as the shaders read it (glsl/scene_records.h): pixel units of the view, computed in double
// precision, so that a view far from the origin loses nothing.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace penumbra {

struct PackedScene {
    std::vector<glm::vec4> shapes;        // kShapeTexels per shape
    std::vector<glm::vec4> edges;         // x0 y0 x1 y1
    std::vector<std::uint32_t> texels;    // RGBA8 of all bitmaps
    std::vector<glm::vec4> media;         // translucent shapes, whose records come last: glsl/scene_records.h
    std::size_t opaque = 0;               // shapes before the translucent ones
    std::size_t bytes() const { return 16 * (shapes.size() + edges.size() + media.size()) + 4 * texels.size(); }
};

// World to view pixels.
struct PixelFrame {
    Point origin{0};
    double pixels_per_unit = 1;
    explicit PixelFrame(const Canvas& canvas);
    glm::dvec2 point(Point p) const { return (p - origin) * pixels_per_unit; }
    double length(double units) const { return units * pixels_per_unit; }
};

// Emission is divided by `radiance_scale`.
PackedScene pack_scene(const Scene& scene, double radiance_scale);

// The edges that a polyline or polygon is packed into (their count decides the slices).
std::size_t edge_count(const Shape& shape);

// What a stroke or lamp thinner than a march's shortest step is fattened by on each side, given half its
// thickness: then no ray steps over it (docs/methods/rc.md).
double thin_shape_growth(double half_thickness_px);

}  // namespace penumbra
