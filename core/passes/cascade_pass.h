// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/passes/scene_buffers.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads distance, material and the cascade above (none for the last), with the scene buffers bound.
// Writes one cascade: radiance rgb, and in a whether the probe is in free space. One invocation per probe and direction group.
class CascadePass {
public:
    explicit CascadePass(const std::string& shader_dir);
    PassWork run(const Plan& plan, std::size_t level, const Sky& sky, const SceneBuffers& scene,
                 const DistanceField& field, const gl::Texture2D* upper, const PassSettings& settings, gl::Texture2D& out);

private:
    gl::ProgramForms program_;
};

}  // namespace penumbra
