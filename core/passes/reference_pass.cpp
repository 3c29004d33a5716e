// SPDX-License-Identifier: MIT
#include "core/passes/reference_pass.h"

#include <algorithm>

#include "glsl/reference.h"

namespace penumbra {

ReferencePass::ReferencePass(const std::string& shader_dir)
    : program_("reference.comp", sizeof(glsl::ReferenceParams), shader_dir) {}

PassWork ReferencePass::run(const Plan& plan, const Sky& sky, const SceneBuffers& scene, const DistanceField& field,
                            const PassSettings& settings, gl::Texture2D& out) {
    out = settings.take(GL_RGBA32F, plan.lit.size);
    glsl::ReferenceParams params{};
    params.extent = plan.lit.size;
    params.first_pixel = plan.lit.first;
    params.border = plan.grid.border;
    params.shape_count = plan.shape_slices.empty() ? 0 : plan.shape_slices.back().end;
    params.ray_count = plan.reference.rays;
    params.sky_first = scene.has_sky_table() ? 0 : -1;
    const PixelBox& domain = plan.grid.domain;
    params.domain = {float(domain.x0), float(domain.y0), float(domain.x1), float(domain.y1)};
    params.sky = glm::vec4(glm::vec3(sky.radiance / plan.radiance_scale), 0.0f);
    out.bind_image(glsl::kReferenceImageBinding, GL_READ_WRITE);
    field.distance.bind_texture(glsl::kReferenceDistanceUnit);

    PassWork work;
    for (int ray = 0; ray < plan.reference.rays; ray += plan.reference.rays_per_dispatch) {
        params.first_ray = ray;
        params.end_ray = std::min(ray + plan.reference.rays_per_dispatch, plan.reference.rays);
        params.is_last = params.end_ray == plan.reference.rays ? 1 : 0;
        const std::size_t cost = static_cast<std::size_t>(params.end_ray - ray) * plan.reference.tests_per_ray;
        work.dispatches += program_.of(light_constants(plan.needs)).dispatch(params, plan.lit.size, settings.distance_iterations / std::max<std::size_t>(cost, 1));
    }
    work.rays = static_cast<std::size_t>(plan.reference.rays) * static_cast<std::size_t>(plan.lit.size.x) *
                static_cast<std::size_t>(plan.lit.size.y);
    work.bytes = out.bytes();
    return work;
}

}  // namespace penumbra
