// SPDX-License-Identifier: MIT
#include "core/plan/surface_cells.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "glsl/exact.h"
#include "glsl/surface_records.h"

namespace penumbra {
namespace {

// Whether the line from a to b comes into the box: it is cut off at each of its sides (Liang and Barsky, 1984).
bool passes(glm::vec2 a, glm::vec2 b, glm::vec2 low, glm::vec2 high) {
    float from = 0, to = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const float way = b[axis] - a[axis];
        if (way == 0) {
            if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
            continue;
        }
        const float one = (low[axis] - a[axis]) / way, other = (high[axis] - a[axis]) / way;
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
    }
    return from <= to;
}

}  // namespace

SurfaceCells surface_cells(const Surfaces& surfaces, const std::vector<glm::vec4>& elements, const GridPlan& grid) {
    constexpr int kSide = glsl::kSurfaceCell;
    const glm::ivec2 cells = (grid.size + kSide - 1) / kSide;
    const glm::vec2 origin(-glm::vec2(grid.border));
    const auto index_of = [&](int x, int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.x) + static_cast<std::size_t>(x); };
    // visit(cell, chord), for all cells that a chord comes near to.
    const auto each = [&](const auto& visit) {
        for (std::size_t i = 0; i < surfaces.chords.size(); ++i) {
            const glm::vec2 a(surfaces.chords[i].ends.x, surfaces.chords[i].ends.y), b(surfaces.chords[i].ends.z, surfaces.chords[i].ends.w);
            const auto cell = [&](glm::vec2 p) {
                return glm::ivec2(glm::clamp(glm::floor((p - origin) / float(kSide)), glm::vec2(0), glm::vec2(cells - 1)));
            };
            const glm::vec2 reach(glsl::kSurfaceReach);
            const glm::ivec2 first = cell(glm::min(a, b) - reach), last = cell(glm::max(a, b) + reach);
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x) {
                    const glm::vec2 low = origin + float(kSide) * glm::vec2(x, y);
                    if (passes(a, b, low - reach, low + float(kSide) + reach)) visit(index_of(x, y), i);
                }
        }
    };
    std::vector<std::uint32_t> counts(index_of(0, cells.y));
    each([&](std::size_t cell, std::size_t) { counts[cell] = std::min(counts[cell] + 1, std::uint32_t(glsl::kMostSurfaceChords)); });
    SurfaceCells out;
    out.heads.emplace_back(cells.x, cells.y);
    std::uint32_t total = 0;
    for (const std::uint32_t count : counts) {
        out.heads.emplace_back(total, total);
        total += count;
    }
    std::vector<std::uint32_t> listed(total);
    each([&](std::size_t cell, std::size_t chord) {
        glm::uvec2& head = out.heads[cell + 1];
        if (head.y - head.x < counts[cell]) listed[head.y++] = static_cast<std::uint32_t>(chord);
    });
    out.chords.reserve(std::size_t(total) * glsl::kSurfaceChordTexels);
    for (const std::uint32_t chord : listed) {
        const Surfaces::Chord& c = surfaces.chords[chord];
        const std::size_t at = std::size_t(c.element) * glsl::kExactElementTexels;
        out.chords.push_back(c.ends);
        out.chords.push_back(elements[at + 1]);
        out.chords.push_back(elements[at + 2]);
    }
    return out;
}

}  // namespace penumbra
