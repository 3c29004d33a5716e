// SPDX-License-Identifier: MIT
#include "core/scene/lower.h"

#include <algorithm>

namespace penumbra {
namespace {

bool is_lamp(const Light& light) {
    const auto* point = std::get_if<PointLight>(&light);
    return point != nullptr && point->radius > 0;
}

bool is_translucent(const Shape& shape) { return shape.medium.has_value(); }

bool is_clear(const Shape& shape) { return shape.medium->extinction == Colour(0) && shape.medium->emission == Colour(0); }

}  // namespace

bool needs_lowering(const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(), is_lamp) || std::any_of(scene.shapes.begin(), scene.shapes.end(), is_translucent);
}

Scene lowered(const Scene& scene) {
    Scene result = scene;
    for (const Shape& shape : scene.shapes)
        if (is_translucent(shape)) result.media.push_back(shape);
    std::erase_if(result.shapes, is_translucent);
    // One that does nothing may still lie over another that does.
    if (std::all_of(result.media.begin(), result.media.end(), is_clear)) result.media.clear();
    for (const Light& light : scene.lights) {
        if (!is_lamp(light)) continue;
        const auto& point = std::get<PointLight>(light);
        Shape lamp;
        lamp.geometry = Circle{point.position, point.radius};
        lamp.emission = point.intensity / (2 * point.radius);
        result.shapes.push_back(lamp);
    }
    std::erase_if(result.lights, is_lamp);
    return result;
}

}  // namespace penumbra
