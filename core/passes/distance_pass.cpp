// SPDX-License-Identifier: MIT
#include "core/passes/distance_pass.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <glm/ext/vector_int4.hpp>

#include "glsl/distance.h"
#include "glsl/scene_records.h"

namespace penumbra {
namespace {

// Tiles of one slice of the lists, those whose shapes have short formulas apart: Mesa 22 runs both sides of every branch, so that
// where one ellipse may be asked all pixels pay for it.
struct TileJobs {
    std::vector<glm::ivec4> plain;    // circles, rects and lines alone
    std::vector<glm::ivec4> general;  // of anything in the scene
    bool complete = true;             // no tile of the rows is without shapes
};

bool is_plain(const PackedScene& scene, int shape) {
    const int type = static_cast<int>(scene.shapes[static_cast<std::size_t>(shape) * glsl::kShapeTexels].x);
    return type == glsl::kShapeCircle || type == glsl::kShapeRect || type == glsl::kShapeLine;
}

// `with_empty`: tiles without shapes are jobs as well, which say so pixel by pixel.
TileJobs jobs_of(const Plan& plan, const PackedScene& scene, const ShapeLists& lists, int slice, bool apart, bool with_empty) {
    TileJobs jobs;
    constexpr int side = glsl::kDistanceTile;
    const int end_row = std::min((plan.end_distance_row + side - 1) / side, lists.tiles.y);
    for (int y = plan.first_distance_row / side; y < end_row; ++y)
        for (int x = 0; x < lists.tiles.x; ++x) {
            const std::size_t tile = static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.tiles.x) + static_cast<std::size_t>(x);
            const glm::ivec2 range = lists.ranges[static_cast<std::size_t>(slice) * lists.tile_count() + tile];
            if (range.x == range.y && !with_empty) {
                jobs.complete = false;
                continue;
            }
            const auto first = lists.shapes.begin() + range.x, end = lists.shapes.begin() + range.y;
            const bool plain = range.x < range.y && apart && std::all_of(first, end, [&](int shape) { return is_plain(scene, shape); });
            (plain ? jobs.plain : jobs.general).emplace_back(x * side, y * side, range.x, range.y);
        }
    return jobs;
}

}  // namespace

DistancePass::DistancePass(const std::string& shader_dir)
    : program_("distance.comp", sizeof(glsl::DistanceParams), shader_dir) {}

PassWork DistancePass::run(const Plan& plan, const PackedScene& scene, const ShapeLists& lists, const PassSettings& settings, DistanceField& out) {
    out.distance = settings.take(GL_R32F, plan.grid.size);
    out.material = settings.take(GL_R32I, plan.grid.size);
    PassWork work;
    glsl::DistanceParams params{};
    params.extent = plan.grid.size;
    params.border = plan.grid.border;
    params.far_px = static_cast<float>(plan.grid.diagonal_px);
    const auto slice_for = [&](double shapes) { return static_cast<std::size_t>(double(settings.distance_iterations) / std::max(shapes, 1.0)); };
    const auto bind = [&] {
        out.distance.bind_image(glsl::kDistanceImageBinding, GL_READ_WRITE);
        out.material.bind_image(glsl::kMaterialImageBinding, GL_READ_WRITE);
    };
    gl::ShaderConstants constants = scene_constants(plan.needs);
    if (lists.tiles.x == 0) {
        bind();
        gl::ComputeProgram& program = program_.of(constants);
        for (const ShapeSlice& slice : plan.shape_slices) {
            params.first_shape = slice.first;
            params.end_shape = slice.end;
            work.dispatches +=
                program.dispatch(params, {plan.grid.size.x, plan.end_distance_row}, slice_for(slice.end - slice.first), plan.first_distance_row);
            work.bytes += out.distance.bytes() + out.material.bytes();
            params.continues = 1;
        }
        return work;
    }

    const gl::BufferTexture shapes(GL_R32I, lists.shapes.data(), lists.shapes.size() * sizeof(int));
    constants.emplace_back("kDistanceByTiles", 1);
    const bool apart = !plan.needs.general && (plan.needs.ellipses || plan.needs.outlines || plan.needs.bitmaps);
    for (int slice = 0; slice < lists.slices; ++slice) {
        const TileJobs jobs = jobs_of(plan, scene, lists, slice, apart, slice == 0 && settings.slow_clears);
        if (slice == 0 && !jobs.complete) {
            out.distance.clear(params.far_px);
            out.material.clear(-1);
        }
        bind();
        shapes.bind_texture(glsl::kTileShapesUnit);
        const auto ask = [&](const std::vector<glm::ivec4>& tiles, const gl::ShaderConstants& form) {
            if (tiles.empty()) return;
            const gl::BufferTexture texels(GL_RGBA32I, tiles.data(), tiles.size() * sizeof(glm::ivec4));
            texels.bind_texture(glsl::kTileJobsUnit);
            params.jobs = static_cast<int>(tiles.size());
            constexpr int pixels = glsl::kDistanceTile * glsl::kDistanceTile;
            double asked = 0;
            for (const glm::ivec4 tile : tiles) asked += tile.w - tile.z;
            work.dispatches += program_.of(form).dispatch(params, {pixels, params.jobs}, slice_for(asked / double(tiles.size())));
            work.bytes += tiles.size() * pixels * 8;
        };
        ask(jobs.general, constants);
        if (apart) {
            ProgramNeeds plain = plan.needs;
            plain.ellipses = plain.outlines = plain.bitmaps = false;
            gl::ShaderConstants form = scene_constants(plain);
            form.emplace_back("kDistanceByTiles", 1);
            ask(jobs.plain, form);
        }
        params.continues = 1;
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
