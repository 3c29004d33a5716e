// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Writes, over the distance and the material, the tiles that outlines close off from all light: solid, and of no shape, so that no
// later pass looks there. One invocation per pixel of such tiles.
class ClosedPass {
public:
    explicit ClosedPass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const PassSettings& settings, DistanceField& field);

private:
    gl::ComputeProgram program_;
};

}  // namespace penumbra
