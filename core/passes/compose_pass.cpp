// SPDX-License-Identifier: MIT
#include "core/passes/compose_pass.h"

#include <vector>

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

glsl::ComposeParams params_of(const Plan& plan, const Scene& scene, const FrameLight& light, glm::ivec2 first, gl::Texture2D& out) {
    glsl::ComposeParams params{};
    params.extent = plan.canvas;
    params.border = plan.grid.border;
    params.antialias = scene.output.antialias ? 1 : 0;
    params.floor_albedo = glm::vec4(glm::vec3(scene.canvas.floor_albedo), 1.0f);
    params.radiance_scale = static_cast<float>(plan.radiance_scale);
    params.first_pixel = first;
    // hrc finds the light of the whole canvas.
    params.first_lit = plan.hrc.active() && !light.of_floor ? glm::ivec2(0) : plan.lit.first;
    if (light.of_floor) params.floor_albedo = glm::vec4(glm::vec3(static_cast<float>(1 / plan.radiance_scale)), 1.0f);
    params.has_shapes = scene.shapes.empty() ? 0 : 1;
    light.radiance->bind_texture(glsl::kComposeRadianceUnit);
    light.lights->bind_texture(glsl::kComposeLightsUnit);
    light.field.distance.bind_image(glsl::kComposeDistanceImage, GL_READ_ONLY);
    light.field.material.bind_image(glsl::kComposeMaterialImage, GL_READ_ONLY);
    out.bind_image(glsl::kComposeImageBinding, GL_WRITE_ONLY);
    return params;
}

// For programs that are made for the scene: one texel stands for light that is black everywhere (or is all of a picture of one pixel).
void add_light_constants(const Plan& plan, const FrameLight& light, const gl::Texture2D& lit, gl::ShaderConstants& constants) {
    const glm::ivec2 texel(1, 1);
    if (plan.needs.general || plan.canvas == texel || plan.lit.size == texel) return;
    constants.emplace_back("kComposeLights", light.lights->size() == texel ? 0 : 1);
    constants.emplace_back("kComposeLit", lit.size() == texel ? 0 : 1);
}

PassWork work_of(int dispatches, const gl::Texture2D& out) {
    PassWork work;
    work.dispatches = dispatches;
    work.bytes = out.bytes();
    return work;
}

}  // namespace

ComposePass::ComposePass(const std::string& shader_dir)
    : display_("compose.comp", sizeof(glsl::ComposeParams), shader_dir), linear_("linear.comp", sizeof(glsl::ComposeParams), shader_dir) {}

void ComposePass::set_tone_lut(const ToneLut& lut) {
    std::vector<glm::vec4> texels;
    for (const glm::vec3 colour : lut.texels) texels.emplace_back(colour, 1.0f);
    gl::Texture2D texture(GL_RGBA32F, {lut.size, lut.size * lut.size});
    texture.write(GL_RGBA, GL_FLOAT, texels.data());
    tone_lut_ = std::move(texture);
}

PassWork ComposePass::display(const Plan& plan, const Scene& scene, double exposure, const FrameLight& light, const PassSettings& settings,
                              glm::ivec2 first, gl::Texture2D& out) {
    // One curve a program, whatever is skipped: all of them in one would cost all of them.
    const OutputSettings& output = scene.output;
    gl::ShaderConstants constants = scene_constants(plan.needs);
    constants.emplace_back("kComposeTonemap", tonemap_index(output.tonemap));
    constants.emplace_back("kComposeLook", look_index(output.look.value_or("none")));
    constants.emplace_back("kComposeDither", output.dither == Dither::none ? 0 : 1);
    if (!plan.needs.general) constants.emplace_back("kEdges", scene.shapes.empty() ? 0 : output.antialias ? 2 : 1);
    add_light_constants(plan, light, lit_, constants);
    gl::ComputeProgram& program = display_.of(constants);
    glsl::ComposeParams params = params_of(plan, scene, light, first, out);
    params.levels = out.format() == GL_RGBA16 ? 65535 : 255;
    params.exposure = static_cast<float>(exposure);
    params.white = static_cast<float>(output.white.value_or(kDefaultWhite));
    lit_.bind_texture(glsl::kComposeLitUnit);
    if (tone_lut_) tone_lut_.bind_texture(glsl::kComposeLutUnit);
    return work_of(program.dispatch(params, out.size(), settings.pixels), out);
}

PassWork ComposePass::linear(const Plan& plan, const Scene& scene, const FrameLight& light, const PassSettings& settings, glm::ivec2 first,
                             gl::Texture2D& out) {
    gl::ShaderConstants constants = scene_constants(plan.needs);
    add_light_constants(plan, light, lit_, constants);
    gl::ComputeProgram& program = linear_.of(constants);
    const glsl::ComposeParams params = params_of(plan, scene, light, first, out);
    lit_.bind_texture(glsl::kComposeLitUnit);
    return work_of(program.dispatch(params, out.size(), settings.pixels), out);
}

}  // namespace penumbra
