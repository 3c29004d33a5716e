// SPDX-License-Identifier: MIT
#include "core/passes/distance_pass.h"

#include <algorithm>

#include "glsl/distance.h"

namespace penumbra {

DistancePass::DistancePass(const std::string& shader_dir)
    : program_("distance.comp", sizeof(glsl::DistanceParams), shader_dir) {}

PassWork DistancePass::run(const Plan& plan, const ShapeLists& lists, const PassSettings& settings, DistanceField& out) {
    out.distance = settings.take(GL_R32F, plan.grid.size);
    out.material = settings.take(GL_R32I, plan.grid.size);
    out.distance.bind_image(glsl::kDistanceImageBinding, GL_READ_WRITE);
    out.material.bind_image(glsl::kMaterialImageBinding, GL_READ_WRITE);
    PassWork work;
    gl::ComputeProgram& program = program_.of(scene_constants(plan.needs));
    glsl::DistanceParams params{};
    params.extent = plan.grid.size;
    params.border = plan.grid.border;
    params.far_px = static_cast<float>(plan.grid.diagonal_px);
    const auto dispatch = [&](double shapes) {
        const auto slice = static_cast<std::size_t>(double(settings.distance_iterations) / std::max(shapes, 1.0));
        work.dispatches += program.dispatch(params, {plan.grid.size.x, plan.end_distance_row}, slice, plan.first_distance_row);
        work.bytes += out.distance.bytes() + out.material.bytes();
        params.continues = 1;
    };
    const gl::BufferTexture ranges(GL_RG32I, lists.ranges.data(), lists.ranges.size() * sizeof(glm::ivec2));
    const gl::BufferTexture shapes(GL_R32I, lists.shapes.data(), lists.shapes.size() * sizeof(int));
    ranges.bind_texture(glsl::kTileRangesUnit);
    shapes.bind_texture(glsl::kTileShapesUnit);
    if (lists.tiles.x > 0) {
        params.tiles = lists.tiles.x;
        for (int slice = 0; slice < lists.slices; ++slice) {
            params.first_range = slice * static_cast<int>(lists.tile_count());
            dispatch(lists.mean_length);
        }
        return work;
    }
    for (const ShapeSlice& slice : plan.shape_slices) {
        params.first_shape = slice.first;
        params.end_shape = slice.end;
        dispatch(slice.end - slice.first);
    }
    return work;
}

DistanceField DistancePass::empty_field(const Plan& plan) {
    DistanceField field{gl::Texture2D(GL_R32F, {1, 1}), gl::Texture2D(GL_R32I, {1, 1})};
    const auto far_px = static_cast<float>(plan.grid.diagonal_px);
    const int none = -1;
    field.distance.fill(GL_RED, GL_FLOAT, &far_px);
    field.material.fill(GL_RED_INTEGER, GL_INT, &none);
    return field;
}

}  // namespace penumbra
