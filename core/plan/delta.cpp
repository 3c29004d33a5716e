// SPDX-License-Identifier: MIT
#include "core/plan/delta.h"

#include <cmath>
#include <numbers>
#include <variant>

#include "core/plan/pack.h"
#include "glsl/delta.h"

namespace penumbra {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

}  // namespace

int DeltaPlan::size() const { return static_cast<int>(lights.size()) / glsl::kDeltaLightTexels; }

std::vector<glm::vec4> pack_lights(const Scene& scene) {
    const PixelFrame frame(scene.canvas);
    std::vector<glm::vec4> packed;
    const auto add = [&](glm::dvec2 at, int kind, Colour intensity, glm::vec4 spot) {
        if (intensity == Colour(0)) return;
        packed.emplace_back(glm::vec2(at), static_cast<float>(kind), 0.0f);
        packed.emplace_back(glm::vec3(intensity), 0.0f);
        packed.push_back(spot);
    };
    const double per_unit = frame.pixels_per_unit;
    for (const Light& light : scene.lights) {
        if (const auto* point = std::get_if<PointLight>(&light)) {
            add(frame.point(point->position), glsl::kDeltaPoint, point->intensity * per_unit, glm::vec4(0));
        } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
            const double a = spot->direction_deg * kRadians;
            add(frame.point(spot->position), glsl::kDeltaSpot, spot->intensity * per_unit,
                glm::vec4(std::cos(a), std::sin(a), spot->inner_angle_deg * kRadians, spot->outer_angle_deg * kRadians));
        } else {
            const auto& sun = std::get<DirectionalLight>(light);
            const double a = sun.direction_deg * kRadians;
            add({-std::cos(a), -std::sin(a)}, glsl::kDeltaDirectional, sun.irradiance, glm::vec4(0));
        }
    }
    return packed;
}

}  // namespace penumbra
