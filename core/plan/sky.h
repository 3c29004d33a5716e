// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace penumbra {

// Sky radiance in a direction (degrees, clockwise on screen).
Colour sky_radiance(const Sky& sky, double angle_deg);

// Exact mean of the sky over the angles from `from_deg` to `to_deg` (to > from).
Colour sky_mean(const Sky& sky, double from_deg, double to_deg);

// Mean over each of `sectors` equal sectors, the first from angle 0 on.
std::vector<Colour> sky_sectors(const Sky& sky, int sectors);

// The brightest channel anywhere on the sky.
double brightest(const Sky& sky);

}  // namespace penumbra
