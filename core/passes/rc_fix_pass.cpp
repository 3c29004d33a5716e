// SPDX-License-Identifier: MIT
#include "core/passes/rc_fix_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "glsl/rc_fix.h"

namespace penumbra {
namespace {

// The longest ray from a start on the group's direction to a start of an upper probe, on one of the group's four.
double longest_ray(const CascadePlan& c, const CascadePlan& above) {
    // At the edge of the view, upper probes may all lie on one side.
    const glm::dvec2 outwards = glm::abs(c.first_probe - above.first_probe);
    const double aside = std::hypot(std::max(outwards.x, above.spacing), std::max(outwards.y, above.spacing));
    const double turn = 1.5 * 2.0 * std::numbers::pi / c.directions();
    const double along = std::sqrt(c.start * c.start + c.end * c.end - 2.0 * c.start * c.end * std::cos(turn));
    return aside + along;
}

}  // namespace

RcFixPass::RcFixPass(const std::string& shader_dir)
    : joined_("rc_fix.comp", sizeof(glsl::RcFixParams), shader_dir),
      last_("rc_fix_last.comp", sizeof(glsl::RcFixParams), shader_dir) {}

PassWork RcFixPass::run(const Plan& plan, std::size_t level, const Sky& sky, const SceneBuffers& scene,
                        const DistanceField& field, const gl::Texture2D* upper, const PassSettings& settings,
                        gl::Texture2D& out) {
    const CascadePlan& c = plan.cascades[level];
    out = settings.take(plan.half_floats ? GL_RGBA16F : GL_RGBA32F, c.texture, gl::Filter::linear);

    glsl::RcFixParams params{};
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
    if (upper != nullptr) {
        const CascadePlan& above = plan.cascades[level + 1];
        params.upper_probes = above.probes;
        params.upper_tiles = above.tiles;
        params.upper_first = glm::vec2(above.first_probe);
        params.upper_spacing = static_cast<float>(above.spacing);
        params.upper_texel = glm::vec2(1.0 / above.texture.x, 1.0 / above.texture.y);
        params.longest = static_cast<float>(longest_ray(c, above));
        upper->bind_texture(glsl::kCascadeUpperUnit);
    }
    field.distance.bind_texture(glsl::kCascadeDistanceUnit);
    field.material.bind_texture(glsl::kCascadeMaterialUnit);
    out.bind_image(glsl::kCascadeImageBinding, GL_WRITE_ONLY);

    PassWork work;
    const std::size_t rays = upper == nullptr ? 4 : 16;
    work.dispatches = (upper == nullptr ? last_ : joined_).of(march_constants(plan.needs)).dispatch(params, c.texture, settings.rays / rays);
    work.rays = rays * static_cast<std::size_t>(c.texture.x) * static_cast<std::size_t>(c.texture.y);
    work.bytes = out.bytes();
    return work;
}

}  // namespace penumbra
