// SPDX-License-Identifier: MIT
#pragma once

#include "core/passes/compose_pass.h"
#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace penumbra {

// Stands for a whole picture without light.
gl::Texture2D black_texel();

// What solid pixels reflect for the eye (`solids: "lit"`): albedo times the light that arrives at the nearest free pixel, one texel
// a pixel of the canvas. A free pixel holds the same of the shape nearest to it, which may cover some of it. One black texel where nothing reflects. Works on the host: it is asked for
// pictures only, and needs what is nearest, which no device finds at once.
gl::Texture2D lit_solids(const Plan& plan, const Scene& scene, const FrameLight& light);

}  // namespace penumbra
