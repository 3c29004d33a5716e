// SPDX-License-Identifier: MIT
// What the scene format offers for comfort, said with what renderers know.
#pragma once

#include "core/scene/scene.h"

namespace penumbra {

// Whether lowered() would change anything.
bool needs_lowering(const Scene& scene);

// Translucent shapes go to `media`; where none of them takes or gives light, they are gone. Point lights with a radius become circles on top of all shapes: radiant intensity I comes from a disc of radiance
// I / (2 radius), since seen from r away it covers about 2 radius / r of the circle.
Scene lowered(const Scene& scene);

}  // namespace penumbra
