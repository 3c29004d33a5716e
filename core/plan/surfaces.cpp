// SPDX-License-Identifier: MIT
#include "core/plan/surfaces.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr int kFewestElements = 4;
constexpr int kMostElements = 1024;  // a loop of the reflection, well below what Mesa 22 allows

}  // namespace

double element_size(Quality quality) {
    switch (quality) {
        case Quality::draft: return 6;
        case Quality::standard: return 3;
        case Quality::high: return 1.5;
    }
    return 3;
}

int element_count(const SurfaceCourse& course, double size) {
    // Twice as many as equal ones: the spacing in the middle is twice the mean.
    const double count = std::ceil((course.whole ? 1.0 : 2.0) * course.length / size);
    return static_cast<int>(std::clamp<double>(count, course.whole ? 2 * kFewestElements : kFewestElements, kMostElements));
}

double element_start(int index, int count, bool whole) {
    const double x = double(index) / count;
    if (whole) return x;
    return x < 0.5 ? 2 * x * x : 1 - 2 * (1 - x) * (1 - x);
}

SurfaceJobs surface_jobs(const Surfaces& surfaces, glm::ivec2 origin, glm::ivec2 tiles, int tile_px) {
    const auto tile_of = [&](const Surfaces::Node& node) {
        // A tile holds what lies between the centres of its first pixel and of the next tile's.
        const auto along = [&](float at, int from, int count) {
            return std::clamp(static_cast<int>(std::floor((double(at) - 0.5 - from) / tile_px)), 0, count - 1);
        };
        return static_cast<std::uint32_t>(along(node.place.y, origin.y, tiles.y) * tiles.x + along(node.place.x, origin.x, tiles.x));
    };
    struct Placed {
        std::uint32_t tile, node;
    };
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < surfaces.nodes.size(); ++i)
        placed.push_back({tile_of(surfaces.nodes[i]), static_cast<std::uint32_t>(i)});
    std::sort(placed.begin(), placed.end(),
              [](const Placed& a, const Placed& b) { return a.tile != b.tile ? a.tile < b.tile : a.node < b.node; });
    SurfaceJobs jobs;
    for (std::size_t i = 0; i < placed.size();) {
        const std::uint32_t tile = placed[i].tile;
        jobs.tiles.push_back(tile);
        std::size_t last = i;
        for (std::size_t k = 0; k < 4; ++k) {
            if (i + k < placed.size() && placed[i + k].tile == tile) last = i + k;
            const Surfaces::Node& node = surfaces.nodes[placed[last].node];
            jobs.nodes.push_back(node.place);
            jobs.nodes.emplace_back(static_cast<float>(node.element), node.extent.x, node.extent.y, 0.0f);
        }
        i = last + 1;
    }
    return jobs;
}

}  // namespace penumbra
