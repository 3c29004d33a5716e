// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/passes/scene_buffers.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads the distance, with the scene buffers bound. Writes the mean radiance of each pixel by brute force: stratified
// rays, each against each shape. One invocation per pixel and dispatch, a few rays at a time.
class ReferencePass {
public:
    explicit ReferencePass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const Sky& sky, const SceneBuffers& scene, const DistanceField& field,
                 const PassSettings& settings, gl::Texture2D& out);

private:
    gl::ProgramForms program_;
};

}  // namespace penumbra
