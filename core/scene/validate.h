// SPDX-License-Identifier: MIT
#pragma once

#include "core/scene/limits.h"
#include "core/scene/problem.h"
#include "core/scene/scene.h"

namespace penumbra {

// All that is wrong with the values of a scene, in document order; empty when it can be rendered as
// far as its values go. Pointers follow docs/scene-format.md ("/shapes/3/radius").
// Checks every range in scene-format.md and every limit; non-finite numbers are problems too.
Problems validate(const Scene& scene, const Limits& limits = {});

}  // namespace penumbra
