// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads distance and material, with the scene buffers bound. Lowers the distance to that of the nearest
// bitmap pixel. One invocation per grid pixel, each jump.
class JumpFloodPass {
public:
    explicit JumpFloodPass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const PassSettings& settings, DistanceField& field);

private:
    gl::ComputeProgram seed_;
    gl::ComputeProgram flood_;
    gl::ComputeProgram merge_;
};

}  // namespace penumbra
