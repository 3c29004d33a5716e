// SPDX-License-Identifier: MIT
#include "core/passes/floor_pass.h"

#include <vector>

#include "core/floor/floor.h"
#include "glsl/floor.h"

namespace penumbra {
namespace {

static_assert(glsl::kFloorTilts == FloorResponse::kTilts);

bool same(const std::optional<Gloss>& a, const std::optional<Gloss>& b) {
    if (!a || !b) return !a && !b;
    return a->roughness == b->roughness && a->metallic == b->metallic && a->reflectance == b->reflectance;
}

}  // namespace

FloorPass::FloorPass(const std::string& shader_dir) : program_("floor.comp", sizeof(glsl::FloorParams), shader_dir) {}

void FloorPass::prepare(const Plan& plan, const Scene& scene, const PassSettings& settings) {
    const Canvas& canvas = scene.canvas;
    const Floor floor(canvas);
    const ViewRect view = canvas.view_or_default();
    const double pixel = canvas.pixel_size();
    const bool even = floor.is_even();
    const glm::ivec2 size = even ? glm::ivec2(1) : plan.lit.size;
    std::vector<glm::vec4> albedo, normal;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec2 at = glm::dvec2(plan.lit.first + glm::ivec2(x, y)) + 0.5;
            const FloorPlace place = floor.at({view.x + at.x * pixel, view.y + at.y * pixel});
            albedo.emplace_back(glm::vec3(place.albedo), 1.0f);
            if (plan.floor.relief) normal.emplace_back(glm::vec3(place.normal), 0.0f);
        }
    if (normal.empty()) normal.emplace_back(0.0f, 0.0f, 1.0f, 0.0f);
    const auto upload = [&](const std::vector<glm::vec4>& texels) {
        gl::Texture2D texture = settings.take(GL_RGBA32F, texels.size() == 1 ? glm::ivec2(1) : size);
        texture.write(GL_RGBA, GL_FLOAT, texels.data());
        return texture;
    };
    albedo_ = upload(albedo);
    normal_ = upload(normal);
    if (table_ && same(gloss_, canvas.floor.gloss)) return;
    std::vector<glm::vec4> table = floor.response().table();
    const Gloss gloss = canvas.floor.gloss.value_or(Gloss{});
    const double roughness = std::max(gloss.roughness, kLeastRoughness);
    table.push_back(glm::vec4(roughness * roughness, gloss.metallic, 0.16 * gloss.reflectance * gloss.reflectance, 0));
    table_ = gl::BufferTexture(GL_RGBA32F, table.data(), table.size() * sizeof(glm::vec4));
    gloss_ = canvas.floor.gloss;
}

void FloorPass::bind() const {
    albedo_.bind_texture(glsl::kFloorAlbedoUnit);
    normal_.bind_texture(glsl::kFloorNormalUnit);
    table_.bind_texture(glsl::kFloorTableUnit);
}

PassWork FloorPass::run(const Plan& plan, const ArrivingLight& light, const PassSettings& settings, gl::Texture2D& out) {
    out = settings.take(GL_RGBA32F, plan.lit.size);
    gl::ComputeProgram& program =
        program_.of({{"kRelief", plan.floor.relief ? 1 : 0}, {"kGloss", plan.floor.gloss ? 1 : 0}});
    glsl::FloorParams params{};
    params.extent = plan.lit.size;
    // hrc finds the light of the whole canvas.
    params.first_pixel = plan.hrc.active() ? plan.lit.first : glm::ivec2(0);
    params.radiance_scale = static_cast<float>(plan.radiance_scale);
    light.radiance.bind_texture(glsl::kFloorRadianceUnit);
    light.lights.bind_texture(glsl::kFloorLightsUnit);
    light.moment_x.bind_texture(glsl::kFloorMomentXUnit);
    light.moment_y.bind_texture(glsl::kFloorMomentYUnit);
    bind();
    out.bind_image(glsl::kFloorImage, GL_WRITE_ONLY);
    PassWork work;
    work.dispatches = program.dispatch(params, params.extent, settings.pixels);
    work.bytes = out.bytes();
    return work;
}

void FloorPass::give_back(const PassSettings& settings) {
    settings.give(std::move(albedo_));
    settings.give(std::move(normal_));
}

}  // namespace penumbra
