// SPDX-License-Identifier: MIT
#include "core/passes/distance_pass.h"

#include <algorithm>

#include "glsl/distance.h"

namespace penumbra {

DistancePass::DistancePass(const std::string& shader_dir)
    : program_("distance.comp", sizeof(glsl::DistanceParams), shader_dir) {}

PassWork DistancePass::run(const Plan& plan, const PassSettings& settings, DistanceField& out) {
    out.distance = settings.take(GL_R32F, plan.grid.size);
    out.material = settings.take(GL_R32I, plan.grid.size);
    out.distance.bind_image(glsl::kDistanceImageBinding, GL_READ_WRITE);
    out.material.bind_image(glsl::kMaterialImageBinding, GL_READ_WRITE);
    PassWork work;
    glsl::DistanceParams params{};
    params.extent = plan.grid.size;
    params.border = plan.grid.border;
    params.far_px = static_cast<float>(plan.grid.diagonal_px);
    for (const ShapeSlice& slice : plan.shape_slices) {
        params.first_shape = slice.first;
        params.end_shape = slice.end;
        const auto shapes = static_cast<std::size_t>(slice.end - slice.first);
        work.dispatches += program_.dispatch(params, plan.grid.size, settings.distance_iterations / std::max<std::size_t>(shapes, 1));
        params.continues = 1;
    }
    work.bytes = plan.shape_slices.size() * (out.distance.bytes() + out.material.bytes());
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
