// SPDX-License-Identifier: MIT
#include "core/passes/compose_pass.h"

#include "core/film/exposure.h"
#include "glsl/compose.h"

namespace penumbra {
namespace {

int tonemap_index(const std::string& name) {
    if (name == "reinhard") return glsl::kTonemapReinhard;
    if (name == "reinhard_extended") return glsl::kTonemapReinhardExtended;
    if (name == "aces") return glsl::kTonemapAces;
    if (name == "aces_narkowicz") return glsl::kTonemapAcesNarkowicz;
    if (name == "agx") return glsl::kTonemapAgx;
    if (name == "pbr_neutral") return glsl::kTonemapPbrNeutral;
    if (name == "tony") return glsl::kTonemapTony;
    return glsl::kTonemapNone;
}

int look_index(const std::string& name) {
    if (name == "golden") return glsl::kLookGolden;
    if (name == "punchy") return glsl::kLookPunchy;
    return glsl::kLookNone;
}

glsl::ComposeParams params_of(const Plan& plan, const Scene& scene, const gl::Texture2D& radiance, const DistanceField& field,
                              int first_row, gl::Texture2D& out) {
    glsl::ComposeParams params{};
    params.extent = plan.canvas;
    params.border = plan.grid.border;
    params.antialias = scene.output.antialias ? 1 : 0;
    params.floor_albedo = glm::vec4(glm::vec3(scene.canvas.floor_albedo), 1.0f);
    params.radiance_scale = static_cast<float>(plan.radiance_scale);
    params.first_row = first_row;
    params.has_shapes = scene.shapes.empty() ? 0 : 1;
    radiance.bind_texture(glsl::kComposeRadianceUnit);
    field.distance.bind_texture(glsl::kComposeDistanceUnit);
    field.material.bind_texture(glsl::kComposeMaterialUnit);
    out.bind_image(glsl::kComposeImageBinding, GL_WRITE_ONLY);
    return params;
}

PassWork work_of(int dispatches, const gl::Texture2D& out) {
    PassWork work;
    work.dispatches = dispatches;
    work.bytes = out.bytes();
    return work;
}

}  // namespace

ComposePass::ComposePass(const std::string& shader_dir)
    : shader_dir_(shader_dir), linear_("linear.comp", sizeof(glsl::ComposeParams), shader_dir) {
    display_for(OutputSettings{});  // a shader that does not build is told at the start
}

void ComposePass::set_tone_lut(const ToneLut& lut) {
    std::vector<glm::vec4> texels;
    for (const glm::vec3 colour : lut.texels) texels.emplace_back(colour, 1.0f);
    gl::Texture2D texture(GL_RGBA32F, {lut.size, lut.size * lut.size});
    texture.write(GL_RGBA, GL_FLOAT, texels.data());
    tone_lut_ = std::move(texture);
}

gl::ComputeProgram& ComposePass::display_for(const OutputSettings& output) {
    const Curve key = {tonemap_index(output.tonemap), look_index(output.look.value_or("none")), output.dither == Dither::none ? 0 : 1};
    const auto found = display_.find(key);
    if (found != display_.end()) return found->second;
    const gl::ShaderConstants constants = {{"kComposeTonemap", key[0]}, {"kComposeLook", key[1]}, {"kComposeDither", key[2]}};
    return display_.emplace(key, gl::ComputeProgram("compose.comp", sizeof(glsl::ComposeParams), shader_dir_, constants)).first->second;
}

PassWork ComposePass::display(const Plan& plan, const Scene& scene, double exposure, const gl::Texture2D& radiance,
                              const DistanceField& field, const PassSettings& settings, int first_row, gl::Texture2D& out) {
    gl::ComputeProgram& program = display_for(scene.output);
    glsl::ComposeParams params = params_of(plan, scene, radiance, field, first_row, out);
    params.levels = out.format() == GL_RGBA16 ? 65535 : 255;
    params.exposure = static_cast<float>(exposure);
    params.white = static_cast<float>(scene.output.white.value_or(kDefaultWhite));
    lit_.bind_texture(glsl::kComposeLitUnit);
    if (tone_lut_) tone_lut_.bind_texture(glsl::kComposeLutUnit);
    return work_of(program.dispatch(params, out.size(), settings.pixels), out);
}

PassWork ComposePass::linear(const Plan& plan, const Scene& scene, const gl::Texture2D& radiance, const DistanceField& field,
                             const PassSettings& settings, int first_row, gl::Texture2D& out) {
    const glsl::ComposeParams params = params_of(plan, scene, radiance, field, first_row, out);
    lit_.bind_texture(glsl::kComposeLitUnit);
    return work_of(linear_.dispatch(params, out.size(), settings.pixels), out);
}

}  // namespace penumbra
