// SPDX-License-Identifier: MIT
#include "core/passes/compose_pass.h"

#include <cmath>

#include "glsl/compose.h"

namespace penumbra {
namespace {

int tonemap_index(const std::string& name) {
    if (name == "reinhard") return glsl::kTonemapReinhard;
    if (name == "reinhard_extended") return glsl::kTonemapReinhardExtended;
    if (name == "aces") return glsl::kTonemapAces;
    if (name == "agx") return glsl::kTonemapAgx;
    if (name == "pbr_neutral") return glsl::kTonemapPbrNeutral;
    return glsl::kTonemapNone;
}

// The radiance that Reinhard's extended curve maps to 1 (docs/scene-format.md).
constexpr float kReinhardWhite = 4.0f;

}  // namespace

ComposePass::ComposePass(const std::string& shader_dir)
    : display_("compose.comp", sizeof(glsl::ComposeParams), shader_dir),
      linear_("linear.comp", sizeof(glsl::ComposeParams), shader_dir) {}

PassWork ComposePass::run(const Plan& plan, const Scene& scene, bool linear, const gl::Texture2D& radiance,
                          const gl::Texture2D& lights, const DistanceField& field, const PassSettings& settings, int first_row,
                          gl::Texture2D& out) {
    glsl::ComposeParams params{};
    params.extent = plan.canvas;
    params.border = plan.grid.border;
    params.antialias = scene.output.antialias ? 1 : 0;
    params.tonemap = tonemap_index(scene.output.tonemap);
    params.floor_albedo = glm::vec4(glm::vec3(scene.canvas.floor_albedo), 1.0f);
    params.exposure = static_cast<float>(std::exp2(scene.output.exposure_ev));
    params.radiance_scale = static_cast<float>(plan.radiance_scale);
    params.white = kReinhardWhite;
    params.first_pixel = plan.shown.first + glm::ivec2(0, first_row);
    // hrc finds the light of the whole canvas.
    params.first_lit = plan.hrc.active() ? glm::ivec2(0) : plan.lit.first;
    params.has_shapes = scene.shapes.empty() ? 0 : 1;
    radiance.bind_texture(glsl::kComposeRadianceUnit);
    lights.bind_texture(glsl::kComposeLightsUnit);
    field.distance.bind_texture(glsl::kComposeDistanceUnit);
    field.material.bind_texture(glsl::kComposeMaterialUnit);
    out.bind_image(glsl::kComposeImageBinding, GL_WRITE_ONLY);
    gl::ShaderConstants constants = scene_constants(plan.needs);
    if (!plan.needs.general && !linear) {
        constants.emplace_back("kCurve", params.tonemap);
        constants.emplace_back("kEdges", params.has_shapes == 0 ? 0 : params.antialias != 0 ? 2 : 1);
    }
    PassWork work;
    work.dispatches = (linear ? linear_ : display_).of(constants).dispatch(params, out.size(), settings.pixels);
    work.bytes = out.bytes();
    return work;
}

}  // namespace penumbra
