// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads the mean radiance of each pixel of the canvas and that of each lit one, by light of other lamps. Writes their sum for the
// canvas, one invocation per pixel.
class SumPass {
public:
    explicit SumPass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const gl::Texture2D& sampled, const gl::Texture2D& solved, const PassSettings& settings, gl::Texture2D& out);

private:
    gl::ComputeProgram program_;
};

}  // namespace penumbra
