// SPDX-License-Identifier: MIT
#include "core/passes/jump_flood_pass.h"

#include <utility>

#include "glsl/jump.h"

namespace penumbra {

JumpFloodPass::JumpFloodPass(const std::string& shader_dir)
    : seed_("jump_seed.comp", sizeof(glsl::JumpParams), shader_dir),
      flood_("jump_flood.comp", sizeof(glsl::JumpParams), shader_dir),
      merge_("jump_merge.comp", sizeof(glsl::JumpParams), shader_dir) {}

PassWork JumpFloodPass::run(const Plan& plan, const PassSettings& settings, DistanceField& field) {
    gl::Texture2D from = settings.take(GL_RG16I, plan.grid.size);
    gl::Texture2D to = settings.take(GL_RG16I, plan.grid.size);
    glsl::JumpParams params{};
    params.extent = plan.grid.size;
    PassWork work;

    field.distance.bind_image(glsl::kJumpDistanceBinding, GL_READ_WRITE);
    field.material.bind_texture(glsl::kJumpMaterialUnit);
    to.bind_image(glsl::kJumpImageBinding, GL_WRITE_ONLY);
    work.dispatches += seed_.dispatch(params, plan.grid.size, settings.pixels);

    for (const int step : plan.jump_steps) {
        std::swap(from, to);
        from.bind_texture(glsl::kJumpSeedsUnit);
        to.bind_image(glsl::kJumpImageBinding, GL_WRITE_ONLY);
        params.step = step;
        work.dispatches += flood_.dispatch(params, plan.grid.size, settings.pixels);
    }

    to.bind_texture(glsl::kJumpSeedsUnit);
    work.dispatches += merge_.dispatch(params, plan.grid.size, settings.pixels);
    work.bytes = (plan.jump_steps.size() + 1) * to.bytes();
    settings.give(std::move(from));
    settings.give(std::move(to));
    return work;
}

}  // namespace penumbra
