// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/pack.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads distance and material, with the scene buffers bound. Lowers the distance to that of the nearest bitmap pixel where one is in
// a window of kNearSeeds px to each side: exact there, and elsewhere left as it is. One invocation per pixel of the tiles that a bitmap's
// box is near.
class NearBitmapsPass {
public:
    explicit NearBitmapsPass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const PackedScene& scene, const PassSettings& settings, DistanceField& field);

private:
    gl::ComputeProgram seeds_;
    gl::ComputeProgram columns_;
    gl::ComputeProgram merge_;
};

}  // namespace penumbra
