// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/pack.h"
#include "core/plan/plan.h"
#include "core/plan/shape_lists.h"

namespace penumbra {

// Reads the scene buffers (bound), and the lists of near shapes where there are some. Writes distance and material, one invocation
// per grid pixel; tiles whose lists are empty are as far as the diagonal, and of no shape.
class DistancePass {
public:
    explicit DistancePass(const std::string& shader_dir);
    PassWork run(const Plan& plan, const PackedScene& scene, const ShapeLists& lists, const PassSettings& settings, DistanceField& out);

    // The field of a scene without shapes: one texel, as far as the diagonal.
    static DistanceField empty_field(const Plan& plan);

private:
    gl::ProgramForms program_;
};

}  // namespace penumbra
