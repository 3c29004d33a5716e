// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Reads the scene buffers (bound). Writes distance and material, one invocation per grid pixel.
class DistancePass {
public:
    explicit DistancePass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const PassSettings& settings, DistanceField& out);

    // The field of a scene without shapes: one texel, as far as the diagonal.
    static DistanceField empty_field(const Plan& plan);

private:
    gl::ComputeProgram program_;
};

}  // namespace penumbra
