// SPDX-License-Identifier: MIT
#include "core/passes/resolve_pass.h"

#include "glsl/resolve.h"

namespace penumbra {

ResolvePass::ResolvePass(const std::string& shader_dir)
    : program_("resolve.comp", sizeof(glsl::ResolveParams), shader_dir) {}

PassWork ResolvePass::run(const Plan& plan, const gl::Texture2D& cascade, const PassSettings& settings, gl::Texture2D& out) {
    const CascadePlan& c = plan.cascades.front();
    out = settings.take(plan.half_floats ? GL_RGBA16F : GL_RGBA32F, plan.lit.size);
    glsl::ResolveParams params{};
    params.extent = plan.lit.size;
    params.first_pixel = plan.lit.first;
    params.probes = c.probes;
    params.tiles = c.tiles;
    params.texel = glm::vec2(1.0 / c.texture.x, 1.0 / c.texture.y);
    params.first_probe = glm::vec2(c.first_probe);
    params.spacing = static_cast<float>(c.spacing);
    params.aligned = c.spacing == 1.0 ? 1 : 0;
    cascade.bind_texture(glsl::kResolveCascadeUnit);
    out.bind_image(glsl::kResolveImageBinding, GL_WRITE_ONLY);
    PassWork work;
    work.dispatches = program_.dispatch(params, plan.lit.size, settings.pixels);
    work.bytes = out.bytes();
    return work;
}

}  // namespace penumbra
