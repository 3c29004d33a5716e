// SPDX-License-Identifier: MIT
#include "core/passes/scene_buffers.h"

#include "core/plan/sky.h"
#include "glsl/scene_records.h"

namespace penumbra {
namespace {

// The farthest cascade's sectors from the exact integral; each nearer cascade averages four of the next.
std::vector<glm::vec4> sky_table(const Sky& sky, const Plan& plan) {
    if (plan.hrc.active()) return hrc_cones(plan.hrc, sky, plan.radiance_scale);
    if (sky.gradient.empty()) return {};
    if (plan.reference.rays > 0) {
        std::vector<glm::vec4> table;
        for (const Colour& mean : sky_sectors(sky, plan.reference.rays))
            table.push_back(glm::vec4(glm::vec3(mean / plan.radiance_scale), 0.0f));
        return table;
    }
    if (plan.cascades.empty()) return {};
    const CascadePlan& last = plan.cascades.back();
    std::vector<glm::vec4> table(static_cast<std::size_t>(last.sky_first + last.directions()));
    const std::vector<Colour> sectors = sky_sectors(sky, last.directions());
    for (std::size_t k = 0; k < sectors.size(); ++k) {
        const Colour mean = sectors[k] / plan.radiance_scale;
        table[static_cast<std::size_t>(last.sky_first) + k] = glm::vec4(glm::vec3(mean), 0.0f);
    }
    for (std::size_t level = plan.cascades.size() - 1; level-- > 0;) {
        const CascadePlan& c = plan.cascades[level];
        const CascadePlan& upper = plan.cascades[level + 1];
        for (int k = 0; k < c.directions(); ++k) {
            glm::vec4 sum(0);
            for (int m = 0; m < 4; ++m) sum += table[static_cast<std::size_t>(upper.sky_first + 4 * k + m)];
            table[static_cast<std::size_t>(c.sky_first + k)] = 0.25f * sum;
        }
    }
    return table;
}

}  // namespace

SceneBuffers::SceneBuffers(const PackedScene& scene, const Sky& sky, const Plan& plan)
    : shapes_(GL_RGBA32F, scene.shapes.data(), scene.shapes.size() * sizeof(glm::vec4)),
      edges_(GL_RGBA32F, scene.edges.data(), scene.edges.size() * sizeof(glm::vec4)),
      texels_(GL_RGBA8, scene.texels.data(), scene.texels.size() * sizeof(std::uint32_t)),
      media_(GL_RGBA32F, scene.media.data(), scene.media.size() * sizeof(glm::vec4)) {
    const std::vector<glm::vec4> table = sky_table(sky, plan);
    has_sky_table_ = !table.empty();
    sky_ = gl::BufferTexture(GL_RGBA32F, table.data(), table.size() * sizeof(glm::vec4));
}

void SceneBuffers::bind() const {
    shapes_.bind_texture(glsl::kShapeRecordsUnit);
    edges_.bind_texture(glsl::kEdgesUnit);
    texels_.bind_texture(glsl::kBitmapTexelsUnit);
    sky_.bind_texture(glsl::kSkySectorsUnit);
    if (media_.bytes() > 0) media_.bind_texture(glsl::kMediaUnit);
}

std::size_t SceneBuffers::bytes() const { return shapes_.bytes() + edges_.bytes() + texels_.bytes() + media_.bytes() + sky_.bytes(); }

}  // namespace penumbra
