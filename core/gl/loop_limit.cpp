// SPDX-License-Identifier: MIT
#include "core/gl/loop_limit.h"

#include <array>

#include "core/gl/program.h"
#include "glsl/loop_probe.h"

namespace penumbra::gl {

int measure_loop_limit(const std::string& shader_dir) {
    constexpr int kWanted = 200'000;
    ComputeProgram program("loop_probe.comp", sizeof(glsl::LoopProbeParams), shader_dir);
    Texture2D count(GL_R32I, {8, 1});
    count.bind_image(glsl::kLoopProbeImageBinding, GL_WRITE_ONLY);
    glsl::LoopProbeParams params{};
    params.iterations = kWanted;
    program.dispatch(params, {8, 1});
    std::array<int, 8> made{};
    count.read(GL_RED_INTEGER, GL_INT, made.data());
    // A few of the counted states may equal the value that is left out: one in four billion each.
    return made[0] >= kWanted - 8 ? 0 : made[0];
}

}  // namespace penumbra::gl
