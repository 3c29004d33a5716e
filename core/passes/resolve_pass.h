// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads cascade 0. Writes the mean radiance of each pixel, one invocation per pixel.
class ResolvePass {
public:
    explicit ResolvePass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const gl::Texture2D& cascade, const PassSettings& settings, gl::Texture2D& out);

private:
    gl::ComputeProgram program_;
};

}  // namespace penumbra
