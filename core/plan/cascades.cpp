// SPDX-License-Identifier: MIT
// Radiance cascades: how finely, how far, and which probes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "core/plan/plan.h"

namespace penumbra {

CascadeSettings cascade_settings(Quality quality) {
    // Points of the measured front of rc (docs/benchmarks.md).
    switch (quality) {
        case Quality::draft: return {2.0, 1.2, 1};
        case Quality::standard: return {1.0, 1.2, 1};
        case Quality::high: return {0.5, 1.2, 1};
    }
    return {};
}

CascadeSettings rc_fix_settings(Quality quality) {
    // Points of its own measured front (docs/methods/rc_fix.md). Cascade 0 has a probe at each pixel's centre at any quality:
    // coarser ones take part in the last, exact stretch to each pixel, which is what a cascade -1 would be for.
    switch (quality) {
        case Quality::draft: return {1.0, 2.4, 1, 4.0, 18};
        case Quality::standard: return {1.0, 1.2, 1, 2.0, 18};
        case Quality::high: return {1.0, 0.8, 1, 1.0, 4.5};
    }
    return {};
}

std::vector<CascadePlan> plan_cascades(glm::ivec2 canvas, double diagonal_px, const CascadeSettings& settings) {
    const double ratio = 1.0 + 3.0 * diagonal_px / settings.interval_px;
    // The tolerance keeps an exact power of four from growing a cascade by rounding.
    int count = std::max(1, static_cast<int>(std::ceil(std::log2(ratio) / 2.0 - 1e-12)));
    if (settings.far_gap_px > 0) {
        const double directions = 2.0 * std::numbers::pi * diagonal_px / settings.far_gap_px;
        const double base = 4.0 * settings.base_tiles * settings.base_tiles;
        count = std::clamp(1 + static_cast<int>(std::ceil(std::log2(directions / base) / 2.0)), 1, count);
    }
    std::vector<CascadePlan> cascades;
    int sky_first = 0;
    for (int level = 0; level < count; ++level) {
        CascadePlan c;
        c.level = level;
        c.spacing = level == 0 ? settings.spacing_px : std::ldexp(settings.spacing_px * settings.growth, level - 1);
        const auto along = [&](int pixels) { return std::max(1, static_cast<int>(std::ceil(pixels / c.spacing))); };
        c.probes = {along(canvas.x), along(canvas.y)};
        c.first_probe = 0.5 * (glm::dvec2(canvas) - glm::dvec2(c.probes - 1) * c.spacing);
        const int tiles = settings.base_tiles << level;
        c.tiles = {tiles, tiles};
        c.texture = c.probes * c.tiles;
        c.start = settings.interval_px * (std::ldexp(1.0, 2 * level) - 1.0) / 3.0;
        c.end = c.start + std::ldexp(settings.interval_px, 2 * level);
        c.sky_first = sky_first;
        sky_first += c.directions();
        if (level == count - 1) c.end = std::max(c.end, diagonal_px);
        cascades.push_back(c);
    }
    return cascades;
}

std::size_t leave_out_far(std::vector<CascadePlan>& cascades, const Extent& matters, double diagonal_px) {
    // A ray is judged by its distance to a surface when that is less than this (glsl/lib/march.glsl, kNear).
    constexpr double kNearSurface = 2;
    std::size_t left_out = 0;
    while (cascades.size() > 1) {
        const CascadePlan& last = cascades.back();
        double farthest = 0;
        for (const CascadePlan* c : {&last, static_cast<const CascadePlan*>(&cascades[cascades.size() - 2])}) {
            if (matters.empty()) break;
            const glm::dvec2 low = c->first_probe;
            const glm::dvec2 high = low + glm::dvec2(c->probes - 1) * c->spacing;
            const double x = std::max(matters.x1 - low.x, high.x - matters.x0);
            const double y = std::max(matters.y1 - low.y, high.y - matters.y0);
            farthest = std::max(farthest, std::hypot(x, y));
        }
        if (!matters.empty() && last.start < farthest + kNearSurface) break;
        cascades.pop_back();
        cascades.back().end = std::max(cascades.back().end, diagonal_px);
        ++left_out;
    }
    return left_out;
}

void keep_probes_near(std::vector<CascadePlan>& cascades, const PixelArea& lit) {
    // Centres of what asks: pixels first, then the probes below.
    glm::dvec2 low = glm::dvec2(lit.first) + 0.5;
    glm::dvec2 high = glm::dvec2(lit.end()) - 0.5;
    for (CascadePlan& c : cascades) {
        glm::ivec2 from = lit.first;
        glm::ivec2 to = lit.end() - 1;
        if (c.level > 0 || c.spacing != 1.0) {
            // The two on either side, and one more for rounding.
            from = glm::max(glm::ivec2(glm::floor((low - c.first_probe) / c.spacing)) - 1, glm::ivec2(0));
            to = glm::min(glm::ivec2(glm::ceil((high - c.first_probe) / c.spacing)) + 1, c.probes - 1);
        }
        c.first_probe += glm::dvec2(from) * c.spacing;
        c.probes = to - from + 1;
        c.texture = c.probes * c.tiles;
        low = c.first_probe;
        high = low + glm::dvec2(c.probes - 1) * c.spacing;
    }
}

}  // namespace penumbra
