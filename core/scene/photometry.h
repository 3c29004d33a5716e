// SPDX-License-Identifier: MIT
// Lights in photometric units: what they send in each direction of the world above the canvas.
#pragma once

#include <numbers>

#include "core/scene/scene.h"

namespace penumbra {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

// Luminous intensity in candela, of a spot on its axis, of a light in candela or lumens. All directions together give the lumens
// that were asked for, channel by channel: errata E-17 to E-21.
Colour candela_of(const PointLight& light);
Colour candela_of(const SpotLight& light);

// Share of a spot's intensity in a direction this far from its axis: the squared smooth step (errata E-21).
double spot_share(const SpotLight& light, double angle_rad);

// The solid angle that a spot of intensity 1 on its axis makes up for: the integral of spot_share over all directions.
double spot_solid_angle(const SpotLight& light);

}  // namespace penumbra
