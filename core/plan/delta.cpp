// SPDX-License-Identifier: MIT
#include "core/plan/delta.h"

#include <cmath>
#include <variant>

#include <glm/vec4.hpp>

#include "core/plan/pack.h"
#include "core/scene/photometry.h"
#include "glsl/delta.h"

namespace penumbra {

int DeltaPlan::size() const { return static_cast<int>(lights.size()) / glsl::kDeltaLightTexels; }

std::vector<glm::vec4> pack_lights(const Scene& scene) {
    const PixelFrame frame(scene.canvas);
    const double per_unit = frame.pixels_per_unit;
    std::vector<glm::vec4> packed;
    // `height` and `tilt` stand in the first two texels' last components.
    const auto add = [&](glm::dvec2 at, int kind, double height, Colour intensity, double tilt, glm::dvec4 spot) {
        if (intensity == Colour(0)) return;
        packed.push_back(glm::vec4(glm::vec2(at), static_cast<float>(kind), static_cast<float>(height)));
        packed.push_back(glm::vec4(glm::vec3(intensity), static_cast<float>(tilt)));
        packed.push_back(glm::vec4(spot));
    };
    for (const Light& light : scene.lights) {
        if (const auto* point = std::get_if<PointLight>(&light)) {
            if (point->unit == LightUnit::radiant)
                add(frame.point(point->position), glsl::kDeltaPoint, 0, point->intensity * per_unit, 0, glm::dvec4(0));
            else
                add(frame.point(point->position), glsl::kDeltaPoint | glsl::kDeltaRaised, point->height * per_unit,
                    candela_of(*point) * per_unit * per_unit, 0, glm::dvec4(0));
        } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
            const double a = spot->direction_deg * kRadiansPerDegree;
            const glm::dvec4 cone(std::cos(a), std::sin(a), spot->inner_angle_deg * kRadiansPerDegree, spot->outer_angle_deg * kRadiansPerDegree);
            if (spot->unit == LightUnit::radiant)
                add(frame.point(spot->position), glsl::kDeltaSpot, 0, spot->intensity * per_unit, 0, cone);
            else
                add(frame.point(spot->position), glsl::kDeltaSpot | glsl::kDeltaRaised, spot->height * per_unit,
                    candela_of(*spot) * per_unit * per_unit, spot->tilt_deg * kRadiansPerDegree, cone);
        } else {
            const auto& sun = std::get<DirectionalLight>(light);
            const double a = sun.direction_deg * kRadiansPerDegree;
            const double elevation = sun.elevation_deg.value_or(0) * kRadiansPerDegree;
            add({-std::cos(a), -std::sin(a)}, glsl::kDeltaDirectional | (sun.elevation_deg ? glsl::kDeltaRaised : 0), std::sin(elevation),
                sun.irradiance, std::cos(elevation), glm::dvec4(0));
        }
    }
    return packed;
}

}  // namespace penumbra
