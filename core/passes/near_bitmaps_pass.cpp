// SPDX-License-Identifier: MIT
#include "core/passes/near_bitmaps_pass.h"

#include <cmath>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "glsl/jump.h"
#include "glsl/scene_records.h"

namespace penumbra {
namespace {

// First pixels of the tiles that a bitmap's box comes within the window of, or of all tiles.
std::vector<glm::ivec2> tiles_near_bitmaps(const Plan& plan, const PackedScene& scene, bool all) {
    constexpr int side = glsl::kNearTile;
    constexpr double beside = glsl::kNearSeeds + 1;  // a pixel for rounding
    const glm::ivec2 count = (plan.grid.size + side - 1) / side;
    std::vector<char> asked(static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y), all ? 1 : 0);
    for (std::size_t i = 0; i < scene.opaque; ++i) {
        const glm::vec4* record = &scene.shapes[i * glsl::kShapeTexels];
        if (static_cast<int>(record[0].x) != glsl::kShapeBitmap) continue;
        const glm::dvec2 low = glm::dvec2(record[2].x, record[2].y) + glm::dvec2(plan.grid.border);
        const glm::dvec2 high = low + glm::dvec2(record[2].z, record[2].w);
        const glm::ivec2 from(glm::clamp(glm::floor((low - beside) / double(side)), glm::dvec2(0), glm::dvec2(count)));
        const glm::ivec2 to(glm::clamp(glm::floor((high + beside) / double(side)), glm::dvec2(-1), glm::dvec2(count - 1)));
        for (int y = from.y; y <= to.y; ++y)
            for (int x = from.x; x <= to.x; ++x) asked[static_cast<std::size_t>(y) * static_cast<std::size_t>(count.x) + static_cast<std::size_t>(x)] = 1;
    }
    std::vector<glm::ivec2> tiles;
    for (int y = 0; y < count.y; ++y) {
        if (!all && ((y + 1) * side <= plan.first_distance_row || y * side >= plan.end_distance_row)) continue;
        for (int x = 0; x < count.x; ++x)
            if (asked[static_cast<std::size_t>(y) * static_cast<std::size_t>(count.x) + static_cast<std::size_t>(x)] != 0) tiles.emplace_back(x * side, y * side);
    }
    return tiles;
}

}  // namespace

NearBitmapsPass::NearBitmapsPass(const std::string& shader_dir)
    : seeds_("near_seeds.comp", sizeof(glsl::JumpParams), shader_dir),
      columns_("near_columns.comp", sizeof(glsl::JumpParams), shader_dir),
      merge_("near_merge.comp", sizeof(glsl::JumpParams), shader_dir) {}

PassWork NearBitmapsPass::run(const Plan& plan, const PackedScene& scene, const PassSettings& settings, DistanceField& field) {
    PassWork work;
    const std::vector<glm::ivec2> first = tiles_near_bitmaps(plan, scene, settings.slow_clears);
    if (first.empty()) return work;
    const gl::BufferTexture tiles(GL_RG32I, first.data(), first.size() * sizeof(glm::ivec2));
    gl::Texture2D seeds = settings.take(GL_R8UI, plan.grid.size);
    gl::Texture2D columns = settings.take(GL_R8UI, plan.grid.size);
    if (!settings.slow_clears) {
        // Beside the tiles there are none.
        seeds.clear(GLuint(0));
        columns.clear(GLuint(0));
    }
    glsl::JumpParams params{};
    params.extent = plan.grid.size;
    params.step = static_cast<int>(first.size());
    const glm::ivec2 extent(glsl::kNearTile * glsl::kNearTile, params.step);
    tiles.bind_texture(glsl::kNearTilesUnit);
    field.material.bind_texture(glsl::kJumpMaterialUnit);
    field.distance.bind_image(glsl::kJumpDistanceBinding, GL_READ_WRITE);
    seeds.bind_image(glsl::kNearSeedsImage, GL_READ_WRITE);
    columns.bind_image(glsl::kNearColumnsImage, GL_READ_WRITE);
    for (gl::ComputeProgram* program : {&seeds_, &columns_, &merge_}) work.dispatches += program->dispatch(params, extent, settings.pixels);
    work.bytes = first.size() * glsl::kNearTile * glsl::kNearTile * 6;
    settings.give(std::move(seeds));
    settings.give(std::move(columns));
    return work;
}

}  // namespace penumbra
