// SPDX-License-Identifier: MIT
#include "core/scene/lower.h"

#include <algorithm>

namespace penumbra {
namespace {

bool is_lamp(const Light& light) {
    const auto* point = std::get_if<PointLight>(&light);
    return point != nullptr && point->radius > 0;
}

}  // namespace

bool needs_lowering(const Scene& scene) { return std::any_of(scene.lights.begin(), scene.lights.end(), is_lamp); }

Scene lowered(const Scene& scene) {
    Scene result = scene;
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
