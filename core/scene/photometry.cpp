// SPDX-License-Identifier: MIT
#include "core/scene/photometry.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

// cos a - cos b, which keeps its digits where both are small.
double cosine_difference(double a, double b) { return 2 * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a)); }

}  // namespace

double spot_share(const SpotLight& light, double angle_rad) {
    const double inner = light.inner_angle_deg * kRadiansPerDegree;
    const double outer = light.outer_angle_deg * kRadiansPerDegree;
    if (outer <= inner) return angle_rad <= outer ? 1 : 0;
    const double ramp = std::clamp(cosine_difference(angle_rad, outer) / cosine_difference(inner, outer), 0.0, 1.0);
    return ramp * ramp;
}

double spot_solid_angle(const SpotLight& light) {
    const double inner = light.inner_angle_deg * kRadiansPerDegree;
    const double outer = light.outer_angle_deg * kRadiansPerDegree;
    // The cone of full light, and the mean of a squared ramp, a third, of the rest.
    return 2 * std::numbers::pi * (cosine_difference(0, inner) + cosine_difference(inner, outer) / 3);
}

Colour candela_of(const PointLight& light) {
    return light.unit == LightUnit::lumens ? light.intensity / (4 * std::numbers::pi) : light.intensity;
}

Colour candela_of(const SpotLight& light) {
    return light.unit == LightUnit::lumens ? light.intensity / spot_solid_angle(light) : light.intensity;
}

}  // namespace penumbra
