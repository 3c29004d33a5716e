// SPDX-License-Identifier: MIT
// Outlines as closed rings of points, and what is filled of them.
#pragma once

#include <optional>
#include <vector>

#include "core/outline/crossings.h"
#include "core/scene/scene.h"

namespace penumbra {

using Ring = std::vector<Point>;

// Rings that fill by the even-odd rule what the given ones fill by the nonzero rule: split where they cross, of which the pieces
// between filled and empty are kept. Points move by at most one part in 2^26 of the extent. Empty optional when they are to be split
// at more than `most_splits` places, or when crossings cost more than the work that is left, which what they cost is taken from. Rings too large or too
// small for a grid in double precision come back as they are.
std::optional<std::vector<Ring>> even_odd_of_nonzero(const std::vector<Ring>& rings, std::size_t most_splits, CrossingWork& work);

// Rings of fewer than three distinct points hold nothing and are left out.
Polygon polygon_of(const std::vector<Ring>& rings);

}  // namespace penumbra
