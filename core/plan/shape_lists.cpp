// SPDX-License-Identifier: MIT
#include "core/plan/shape_lists.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/common.hpp>

#include "core/plan/shape_bounds.h"
#include "glsl/distance.h"
#include "glsl/scene_records.h"

namespace penumbra {
namespace {

// Entries of all lists together: 64 MiB.
constexpr std::size_t kMostEntries = std::size_t(1) << 24;

// Halves squares of tiles down to single tiles, each judging only what its parent kept: a shape leaves the list when it is
// surely farther than another or than the reach, everywhere in the square, and covers none of it; or lies below one that covers all
// of it deeper than the reach.
class Lister {
public:
    Lister(const PackedScene& scene, const GridPlan& grid, int first_row, int end_row, double reach_px)
        : scene_(scene), grid_(grid), first_row_(first_row), end_row_(end_row > 0 ? end_row : grid.size.y), reach_px_(reach_px) {
        constexpr int tile = glsl::kDistanceTile;
        lists_.tiles = (grid.size + tile - 1) / tile;
        lists_.ranges.resize(lists_.tile_count());
    }

    // False: the lists are too long to keep.
    bool run() {
        int side = 1;
        while (side < std::max(lists_.tiles.x, lists_.tiles.y)) side *= 2;
        std::vector<int> all(scene_.opaque);
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
        visit({0, 0}, side, all);
        return lists_.shapes.size() <= kMostEntries;
    }

    ShapeLists take() {
        slice();
        return std::move(lists_);
    }

private:
    void visit(glm::ivec2 first, int side, const std::vector<int>& candidates) {
        if (first.x >= lists_.tiles.x || first.y >= lists_.tiles.y || lists_.shapes.size() > kMostEntries) return;
        if (first.y * glsl::kDistanceTile >= end_row_ || (first.y + side) * glsl::kDistanceTile <= first_row_) return;
        bool settled = false;
        const std::vector<int> kept = keep(first, side, candidates, settled);
        if (side > 1 && !settled) {
            const int half = side / 2;
            for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(half, 0), glm::ivec2(0, half), glm::ivec2(half, half)})
                visit(first + corner, half, kept);
            return;
        }
        const auto begin = static_cast<int>(lists_.shapes.size());
        lists_.shapes.insert(lists_.shapes.end(), kept.begin(), kept.end());
        const glm::ivec2 range(begin, static_cast<int>(lists_.shapes.size()));
        const glm::ivec2 end = glm::min(first + side, lists_.tiles);
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x) lists_.ranges[std::size_t(y) * std::size_t(lists_.tiles.x) + std::size_t(x)] = range;
    }

    // `settled`: the tiles below keep the same.
    std::vector<int> keep(glm::ivec2 first, int side, const std::vector<int>& candidates, bool& settled) {
        constexpr int tile = glsl::kDistanceTile;
        const glm::ivec2 lo = first * tile;
        const glm::ivec2 hi = glm::min((first + side) * tile, grid_.size);
        const glm::dvec2 middle = 0.5 * glm::dvec2(lo + hi) - glm::dvec2(grid_.border);
        const glm::dvec2 across = glm::dvec2(hi - lo - 1);
        const double reach = 0.5 * std::hypot(across.x, across.y);
        // A pixel starts with the grid's diagonal as its distance.
        double nearest = std::min(grid_.diagonal_px, reach_px_);
        std::size_t deep = 0;
        lows_.clear();
        highs_.clear();
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const DistanceBounds d = distance_bounds(scene_, static_cast<std::size_t>(candidates[i]), middle, reach, std::max(nearest, 0.0));
            nearest = std::min(nearest, d.high);
            lows_.push_back(d.low);
            highs_.push_back(d.high);
            if (d.high < -reach_px_) deep = i;
        }
        std::vector<int> kept;
        double high = 0;
        // Not to be judged by what is inside: of shapes that cover a pixel, the last counts.
        for (std::size_t i = deep; i < candidates.size(); ++i)
            if (!(lows_[i] > std::max(nearest, 0.0))) {
                kept.push_back(candidates[i]);
                high = highs_[i];
            }
        settled = kept.empty() || (kept.size() == 1 && high <= reach_px_);
        return kept;
    }

    // Lists that are too dear for one invocation go on in further slices.
    void slice() {
        const std::size_t tiles = lists_.tile_count();
        std::size_t length = 0;
        for (std::size_t slice = 0; slice * tiles < lists_.ranges.size(); ++slice) {
            bool more = false;
            std::vector<glm::ivec2> rest(tiles, glm::ivec2(0));
            for (std::size_t i = 0; i < tiles; ++i) {
                glm::ivec2& range = lists_.ranges[slice * tiles + i];
                if (slice == 0) length += static_cast<std::size_t>(range.y - range.x);
                std::size_t spent = 0;
                for (int k = range.x; k < range.y; ++k) {
                    const vec4& head = scene_.shapes[static_cast<std::size_t>(lists_.shapes[static_cast<std::size_t>(k)]) * glsl::kShapeTexels];
                    const std::size_t cost = distance_iterations(static_cast<int>(head.x), static_cast<std::size_t>(head.w));
                    if (k > range.x && spent + cost > kIterationsPerSlice) {
                        rest[i] = {k, range.y};
                        range.y = k;
                        more = true;
                        break;
                    }
                    spent += cost;
                }
            }
            if (more) lists_.ranges.insert(lists_.ranges.end(), rest.begin(), rest.end());
        }
        lists_.slices = static_cast<int>(lists_.ranges.size() / std::max<std::size_t>(tiles, 1));
        lists_.mean_length = double(length) / double(std::max<std::size_t>(tiles, 1));
    }

    using vec4 = glm::vec4;
    const PackedScene& scene_;
    const GridPlan& grid_;
    int first_row_, end_row_;
    double reach_px_;
    std::vector<double> lows_, highs_;
    ShapeLists lists_;
};

}  // namespace

ShapeLists list_shapes(const PackedScene& scene, const GridPlan& grid, int first_row, int end_row, double reach_px) {
    Lister lister(scene, grid, first_row, end_row, reach_px);
    if (lister.run()) return lister.take();
    return {};
}

SkippedWork saved_by_lists(const ShapeLists& lists, const PackedScene& scene, const GridPlan& grid, double reach_px) {
    const double shapes = double(scene.opaque);
    const double pixels = double(grid.size.x) * grid.size.y;
    constexpr int side = glsl::kDistanceTile;
    const std::string square = std::to_string(side) + " x " + std::to_string(side);
    char mean[32], reach[32] = "";
    std::snprintf(mean, sizeof mean, "%.1f", lists.mean_length);
    if (std::isfinite(reach_px)) std::snprintf(reach, sizeof reach, " and within %g px", reach_px);
    return {"distances to far shapes",
            std::string("a tile of ") + square + " pixels asks the shapes that can be nearest in it" + reach + ", " + mean + " on average",
            pixels * (shapes - lists.mean_length)};
}

}  // namespace penumbra
