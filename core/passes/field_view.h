// SPDX-License-Identifier: MIT
#pragma once

#include "core/image/image.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"
#include "core/plan/shape_lists.h"
#include "core/scene/scene.h"

namespace penumbra {

// The debug views of what every method has before the light: distance, normals, tiles. Of the part that is shown.
Image8 draw_field(const Plan& plan, const Scene& scene, const DistanceField& field, const ShapeLists& lists);

}  // namespace penumbra
