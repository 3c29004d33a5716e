// SPDX-License-Identifier: MIT
#include "core/passes/sum_pass.h"

#include "glsl/sum.h"

namespace penumbra {

SumPass::SumPass(const std::string& shader_dir) : program_("sum.comp", sizeof(glsl::SumParams), shader_dir) {}

PassWork SumPass::run(const Plan& plan, const gl::Texture2D& sampled, const gl::Texture2D& solved, const PassSettings& settings,
                      gl::Texture2D& out) {
    out = settings.take(plan.half_floats ? GL_RGBA16F : GL_RGBA32F, sampled.size());
    glsl::SumParams params{};
    params.extent = sampled.size();
    params.first_lit = plan.lit.first;
    sampled.bind_texture(glsl::kSumSampledUnit);
    solved.bind_texture(glsl::kSumSolvedUnit);
    out.bind_image(glsl::kSumImageBinding, GL_WRITE_ONLY);
    PassWork work;
    work.dispatches = program_.dispatch(params, params.extent, settings.pixels);
    work.bytes = out.bytes();
    return work;
}

}  // namespace penumbra
