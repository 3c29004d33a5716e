// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace penumbra {

// Reads mean radiance, what lights without a size add to it, distance and material, with the scene buffers bound. Writes the picture: rgba8 for
// display (coverage, exposure, tone curve, sRGB) or rgba32f linear. One invocation per pixel.
class ComposePass {
public:
    explicit ComposePass(const std::string& shader_dir);
    // Rows `first_row` and on, as many as `out` has.
    PassWork run(const Plan& plan, const Scene& scene, bool linear, const gl::Texture2D& radiance,
                 const gl::Texture2D& lights, const DistanceField& field, const PassSettings& settings, int first_row, gl::Texture2D& out);

private:
    gl::ProgramForms display_;
    gl::ProgramForms linear_;
};

}  // namespace penumbra
