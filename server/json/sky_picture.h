// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/scene.h"

namespace penumbra {

// A row of a picture round the circle, as stops of a gradient: the row's left end is at angle 0, and the radiance is linear between the
// middles of neighbouring texels, round the seam too. Colours are sRGB, made linear, times alpha and `scale`. A row of more than
// `most` texels is averaged to that many parts, each over all that falls into it: the mean stays.
std::vector<SkyStop> sky_of_row(const Texels& texels, int row, double scale, std::size_t most);

}  // namespace penumbra
