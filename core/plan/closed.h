// SPDX-License-Identifier: MIT
// Regions of free space that outlines close off from all light.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/ext/vector_int2.hpp>

#include "core/plan/dark_region.h"
#include "core/plan/pack.h"
#include "core/reference/boundary.h"

namespace penumbra {

// Rings that touch others in a point are left out, and so is what the domain cuts open. Expects no lights without a size and
// nothing that light passes through. At most `most_pieces` of outline are looked at.
std::vector<DarkRegion> dark_regions(const reference::Boundary& boundary, const PixelFrame& frame, std::size_t most_pieces = 20'000);

// First pixels of the tiles, `tile` px across from the view's corner on, that lie inside the regions with all that is within two
// pixels of them; row by row.
std::vector<glm::ivec2> tiles_within(const std::vector<DarkRegion>& regions, glm::ivec2 canvas, int tile);

}  // namespace penumbra
