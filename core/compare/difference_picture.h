// SPDX-License-Identifier: MIT
// Differences as pictures that a person can read.
#pragma once

#include <variant>

#include "core/image/image.h"
#include "core/scene/problem.h"

namespace penumbra {

// A map of values from 0 to 1 (FLIP's, say) in false colour, black over purple and orange to pale
// yellow: lightness rises all the way, so it reads in grey too.
Image8 heat_picture(const ImageF& map);

// Where a linear picture `a` is too bright (red) or too dark (blue) against the truth `b`, relative
// to b + 0.05 mean b. The scale is logarithmic: white up to 0.1 %, full colour from 100 % on. Grey
// where the truth has nothing, green where only the picture lacks a value.
std::variant<Image8, Problem> signed_picture(const ImageF& a, const ImageF& b);

}  // namespace penumbra
