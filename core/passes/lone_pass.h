// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads the mean radiance of each pixel, as interpolated between probes, with the scene buffers bound. Writes that of free pixels
// which no probe could tell (alpha 0), in corners between shapes narrower than the lattice: 64 rays of their own, under the mean of
// the sky. One invocation per pixel.
class LonePass {
public:
    explicit LonePass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const Sky& sky, const DistanceField& field, const PassSettings& settings, gl::Texture2D& radiance);

private:
    gl::ProgramForms program_;
};

}  // namespace penumbra
