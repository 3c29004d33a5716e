// SPDX-License-Identifier: MIT
#include "core/passes/lone_pass.h"

#include "core/plan/sky.h"
#include "glsl/cascade.h"
#include "glsl/lone.h"

namespace penumbra {

LonePass::LonePass(const std::string& shader_dir) : program_("lone.comp", sizeof(glsl::LoneParams), shader_dir) {}

PassWork LonePass::run(const Plan& plan, const Sky& sky, const DistanceField& field, const PassSettings& settings,
                       gl::Texture2D& radiance) {
    glsl::LoneParams params{};
    params.extent = plan.lit.size;
    params.first_pixel = plan.lit.first;
    params.border = plan.grid.border;
    const PixelBox& domain = plan.grid.domain;
    params.domain = {float(domain.x0), float(domain.y0), float(domain.x1), float(domain.y1)};
    params.sky = glm::vec4(glm::vec3(sky_mean(sky, 0, 360) / plan.radiance_scale), 0.0f);
    field.distance.bind_texture(glsl::kCascadeDistanceUnit);
    field.material.bind_texture(glsl::kCascadeMaterialUnit);
    radiance.bind_texture(glsl::kLoneRadianceUnit);
    radiance.bind_image(glsl::kLoneImageBinding, GL_WRITE_ONLY);
    PassWork work;
    work.dispatches = program_.of(march_constants(plan.needs)).dispatch(params, plan.lit.size, settings.pixels);
    return work;
}

}  // namespace penumbra
