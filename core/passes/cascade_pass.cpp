// SPDX-License-Identifier: MIT
#include "core/passes/cascade_pass.h"

#include <cmath>
#include <numbers>

#include "glsl/cascade.h"

namespace penumbra {

CascadePass::CascadePass(const std::string& shader_dir)
    : program_("cascade.comp", sizeof(glsl::CascadeParams), shader_dir) {}

PassWork CascadePass::run(const Plan& plan, std::size_t level, const Sky& sky, const SceneBuffers& scene,
                          const DistanceField& field, const gl::Texture2D* upper, const PassSettings& settings,
                          gl::Texture2D& out) {
    const CascadePlan& c = plan.cascades[level];
    out = settings.take(plan.half_floats ? GL_RGBA16F : GL_RGBA32F, c.texture, gl::Filter::linear);

    glsl::CascadeParams params{};
    params.extent = c.texture;
    params.probes = c.probes;
    params.border = plan.grid.border;
    params.tiles = c.tiles;
    params.first_probe = glm::vec2(c.first_probe);
    const PixelBox& domain = plan.grid.domain;
    params.domain = {float(domain.x0), float(domain.y0), float(domain.x1), float(domain.y1)};
    params.spacing = static_cast<float>(c.spacing);
    params.start = static_cast<float>(c.start);
    params.end = static_cast<float>(c.end);
    const double pi = std::numbers::pi;
    params.group_angle = static_cast<float>(2.0 * pi / (c.tiles.x * c.tiles.y));
    for (int m = 0; m < 4; ++m) {
        const double offset = (m - 1.5) * 2.0 * pi / c.directions();
        params.offset_cos[m] = static_cast<float>(std::cos(offset));
        params.offset_sin[m] = static_cast<float>(std::sin(offset));
    }
    params.sky = glm::vec4(glm::vec3(sky.radiance / plan.radiance_scale), 0.0f);
    params.sky_first = scene.has_sky_table() ? c.sky_first : -1;
    params.is_last = upper == nullptr ? 1 : 0;
    params.upper_probes = c.probes;
    params.upper_tiles = c.tiles;
    params.upper_spacing = params.spacing;
    if (upper != nullptr) {
        const CascadePlan& above = plan.cascades[level + 1];
        params.upper_probes = above.probes;
        params.upper_tiles = above.tiles;
        params.upper_first = glm::vec2(above.first_probe);
        params.upper_spacing = static_cast<float>(above.spacing);
        params.upper_texel = glm::vec2(1.0 / above.texture.x, 1.0 / above.texture.y);
        upper->bind_texture(glsl::kCascadeUpperUnit);
    }
    field.distance.bind_texture(glsl::kCascadeDistanceUnit);
    field.material.bind_texture(glsl::kCascadeMaterialUnit);
    out.bind_image(glsl::kCascadeImageBinding, GL_WRITE_ONLY);

    PassWork work;
    work.dispatches = program_.of(march_constants(plan.needs)).dispatch(params, c.texture, settings.rays / 4);
    work.rays = 4 * static_cast<std::size_t>(c.texture.x) * static_cast<std::size_t>(c.texture.y);
    work.bytes = out.bytes();
    return work;
}

}  // namespace penumbra
