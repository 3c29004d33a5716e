// SPDX-License-Identifier: MIT
// What the files of the method `exact` share.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/passes/exact_pass.h"

namespace penumbra {

inline constexpr int kLevels = 4;  // cells of 8, 4, 2 and 1 pixels

// Iterations that the solver spends on one point in one dispatch at most (kBudget of exact_solve.comp): under what drivers allow that
// end long loops, or a tenth of a second of a GPU.
inline constexpr std::int64_t kMostWork = 30'000, kMostWorkOfLongLoops = 1'000'000;
// Iterations, by their bound, of the groups that a dispatch covers where it is to be short; and groups, however long: a device has some threads.
inline constexpr std::int64_t kSolverSlice = 500'000, kFewestGroups = 16;

// How many dispatches finish every point: a list takes `list_work` iterations at most, one after another of the `sectors` lists of a
// point are asked, and each dispatch begins no list that might not end in it.
inline int solver_dispatches(std::int64_t list_work, int sectors, std::int64_t budget) {
    if (2 * list_work > budget) return sectors;
    return static_cast<int>(std::min<std::int64_t>(sectors, list_work * sectors / (budget - list_work) + 1));
}

inline int divided_up(int a, int b) { return (a + b - 1) / b; }

inline gl::StorageBuffer at_least(gl::StorageBuffer buffer, GLenum format, std::size_t bytes) {
    if (buffer && buffer.bytes() >= bytes) return buffer;
    return gl::StorageBuffer(format, bytes);
}

// Where the points of one level are listed, and how many of them.
struct LevelPoints {
    std::size_t first = 0;        // in the list of points
    std::size_t of_tile = 0;      // room for each tile
    std::size_t first_count = 0;  // in the counters
    std::size_t first_ask = 0;    // in the words of what is asked for

    void write_to(glsl::ExactParams& params) const {
        params.first_point = static_cast<int>(first);
        params.tile_points = static_cast<int>(of_tile);
        params.first_count = static_cast<int>(first_count);
        params.first_ask = static_cast<int>(first_ask);
    }
};

// What the steps of one frame share.
struct ExactPass::Band {
    glsl::ExactParams params{};
    gl::BufferTexture root_entries, root_lights, sectors;
    std::array<gl::BufferTexture, 3> sky;  // by moment
    gl::BufferTexture surfaces, materials;
    gl::Texture2D value, slope_x, slope_y, leaf, lights;
    glm::ivec2 coarse_tiles{0};
    std::array<LevelPoints, kLevels> levels{};
    int most_dispatches = 1;  // of the solver, after which every point is done
    std::int64_t point_work = 1;  // iterations that a point takes at most, all its dispatches together
    glm::ivec2 area{0};  // px that its lists cover

    // So many groups of the solver in rows, each short enough for a dispatch.
    glm::ivec2 solver_rows(int groups) const {
        const auto most = static_cast<int>(std::clamp<std::int64_t>(kSolverSlice / std::clamp<std::int64_t>(point_work, 1, kMostWork), kFewestGroups, 65535));
        const int rows = std::max(divided_up(groups, most), 1);
        return {divided_up(groups, rows) * glsl::kExactSolveGroupX, rows};  // what a row lacks, its groups without a job, is run as well: few
    }
};

}  // namespace penumbra
