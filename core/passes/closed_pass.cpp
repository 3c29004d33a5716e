// SPDX-License-Identifier: MIT
#include "core/passes/closed_pass.h"

#include <vector>

#include <glm/ext/vector_uint2.hpp>

#include "glsl/closed.h"
#include "glsl/exact.h"

namespace penumbra {

ClosedPass::ClosedPass(const std::string& shader_dir) : program_("closed.comp", sizeof(glsl::ClosedParams), shader_dir) {}

PassWork ClosedPass::run(const Plan& plan, const PassSettings& settings, DistanceField& field) {
    const std::vector<glm::uvec2> first(plan.closed_tiles.begin(), plan.closed_tiles.end());
    const gl::BufferTexture tiles(GL_RG32UI, first.data(), first.size() * sizeof(glm::uvec2));
    glsl::ClosedParams params{};
    params.extent = {glsl::kExactTile * glsl::kExactTile, static_cast<int>(first.size())};
    params.canvas = plan.canvas;
    params.border = plan.grid.border;
    params.tile = glsl::kExactTile;
    tiles.bind_texture(glsl::kClosedTilesUnit);
    field.distance.bind_image(glsl::kClosedDistanceImage, GL_WRITE_ONLY);
    field.material.bind_image(glsl::kClosedMaterialImage, GL_WRITE_ONLY);
    PassWork work;
    work.dispatches = program_.dispatch(params, params.extent, settings.pixels);
    return work;
}

}  // namespace penumbra
