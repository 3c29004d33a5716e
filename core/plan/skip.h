// SPDX-License-Identifier: MIT
// What a scene does not need: shapes that nothing can see, and all of the light where it is the same everywhere. Pure
// arithmetic on the scene, before any method is chosen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/render_stats.h"
#include "core/scene/scene.h"

namespace penumbra {

// Shapes farther outside the domain than this cannot come near enough to any point inside that a cell or a short ray is
// judged by its distance to them (px). Those between here and the domain are kept.
constexpr double kKeptBeyondDomain = 8;

// The scene without the shapes that nothing can see: outside the domain, wholly covered by a later one, or without a solid
// texel. None when there is no such shape. Adds to `skipped`, and gives the others new indexes: whoever keeps an index
// keeps it of this scene.
std::optional<Scene> without_unseen_shapes(const Scene& scene, std::vector<SkippedWork>& skipped);

// Where light is the same at every pixel, without a method: nothing shines, or there is only the sky.
struct ConstantLight {
    Colour mean_radiance{0};
    std::string why;
};
std::optional<ConstantLight> constant_light(const Scene& scene);

// Whether a shape's outline sends out light. A bitmap's texels are asked.
bool shines(const Shape& shape);
// Whether it gives back light that arrives.
bool reflects(const Shape& shape);

// The part of the domain, in pixels of the view, that holds every shape, or every one that shines; empty (x1 < x0) without any.
struct Extent {
    double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
    bool empty() const { return x1 < x0; }
};
// With `reflecting`, what reflects shines.
Extent extent_of_shapes(const Scene& scene, bool only_shining, bool reflecting = false);

}  // namespace penumbra
