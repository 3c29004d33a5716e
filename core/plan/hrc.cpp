// SPDX-License-Identifier: MIT
#include "core/plan/hrc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/vec3.hpp>

#include "core/plan/sky.h"

namespace penumbra {
namespace {

// Levels until one stride spans every column.
int level_count(int columns) {
    int levels = 0;
    while ((1 << levels) < columns) ++levels;
    return std::max(levels, 1);
}

void add_levels(HrcQuadrant& q, int climb, int& first_cone) {
    const int top = level_count(q.columns);
    for (int n = 0; n <= top; ++n) {
        const int stride = 1 << n;
        HrcLevel level;
        level.planes = (q.columns + stride - 1) / stride;
        level.cones = 2 * stride / climb;
        level.rays = level.cones + 1;
        level.first_cone = first_cone;
        first_cone += level.cones;
        q.levels.push_back(level);
    }
}

// Where ray k of a level points: how far it climbs per column.
double slope(int level, int climb, int ray) { return std::ldexp(double(climb) * ray, -level) - 1.0; }

double degrees(glm::dvec2 d) { return std::atan2(d.y, d.x) * 180.0 / std::numbers::pi; }

}  // namespace

HrcSettings hrc_settings(Quality quality) {
    switch (quality) {
        case Quality::draft: return {2.0, 1, 3, 0};
        case Quality::standard: return {1.0, 1, 4, 0.125};
        case Quality::high: return {0.5, 1, 5, 0};
    }
    return {};
}

double hrc_cone_angle(int level, int climb, int cone) {
    return std::atan(slope(level, climb, cone + 1)) - std::atan(slope(level, climb, cone));
}

HrcPlan plan_hrc(glm::ivec2 canvas, double margin_px, const HrcSettings& settings) {
    HrcPlan plan;
    plan.settings = settings;
    const double cell = settings.cell_px;
    const auto along_view = [&](int pixels) { return std::max(1, static_cast<int>(std::ceil(pixels / cell))); };
    plan.points = {along_view(canvas.x), along_view(canvas.y)};
    plan.first_point = 0.5 * (glm::dvec2(canvas) - glm::dvec2(plan.points - 1) * cell);
    const int border = static_cast<int>(std::ceil(margin_px / cell));
    const glm::dvec2 last_point = plan.first_point + glm::dvec2(plan.points - 1) * cell;
    int first_cone = 0;
    for (int i = 0; i < 4; ++i) {
        const bool horizontal = i % 2 == 0;
        const bool backward = i >= 2;
        HrcQuadrant q;
        q.columns = (horizontal ? plan.points.x : plan.points.y) + border;
        q.view_rows = horizontal ? plan.points.y : plan.points.x;
        q.rows = q.view_rows + 2 * border;
        q.row_border = border;
        q.along = (backward ? -cell : cell) * (horizontal ? glm::dvec2(1, 0) : glm::dvec2(0, 1));
        q.across = cell * (horizontal ? glm::dvec2(0, 1) : glm::dvec2(1, 0));
        q.first = plan.first_point - double(border) * q.across;
        if (backward && horizontal) q.first.x = last_point.x;
        if (backward && !horizontal) q.first.y = last_point.y;
        add_levels(q, settings.climb, first_cone);
        plan.quadrants.push_back(q);
    }
    return plan;
}

std::size_t hrc_bytes(const HrcPlan& plan, std::size_t texel) {
    std::size_t most = 0;
    for (const HrcQuadrant& q : plan.quadrants) {
        std::size_t pieces = 0;
        std::size_t fluences = 0;
        const auto rows = static_cast<std::size_t>(q.rows);
        for (const HrcLevel& level : q.levels) {
            pieces += static_cast<std::size_t>(plan.halves()) * level.pieces(q.rows);
            fluences = std::max(fluences, rows * static_cast<std::size_t>(level.planes) * static_cast<std::size_t>(level.cones));
        }
        most = std::max(most, texel * (pieces + 2 * fluences) + 4 * q.levels.front().pieces(q.rows));
    }
    return most + 16 * static_cast<std::size_t>(plan.points.x) * static_cast<std::size_t>(plan.points.y);
}

std::vector<glm::vec4> hrc_cones(const HrcPlan& plan, const Sky& sky, double radiance_scale) {
    std::vector<glm::vec4> table;
    const int climb = plan.settings.climb;
    for (const HrcQuadrant& q : plan.quadrants) {
        const int top = q.top();
        // The finest level exactly; each cone below it is the sum of two.
        std::vector<std::vector<Colour>> light(q.levels.size());
        for (int n = top; n >= 0; --n) {
            const int cones = q.levels[static_cast<std::size_t>(n)].cones;
            auto& here = light[static_cast<std::size_t>(n)];
            for (int i = 0; i < cones; ++i) {
                if (n < top) {
                    const auto& finer = light[static_cast<std::size_t>(n) + 1];
                    here.push_back(finer[2 * static_cast<std::size_t>(i)] + finer[2 * static_cast<std::size_t>(i) + 1]);
                    continue;
                }
                const double angle = hrc_cone_angle(n, climb, i);
                // Both edges from one axis, so that no cone reaches over where the angle jumps.
                const double axis = degrees(q.along);
                const double turn = q.along.x * q.across.y - q.along.y * q.across.x > 0 ? 1.0 : -1.0;
                const double a = axis + turn * std::atan(slope(n, climb, i)) * 180.0 / std::numbers::pi;
                const double b = a + turn * angle * 180.0 / std::numbers::pi;
                here.push_back(sky_mean(sky, std::min(a, b), std::max(a, b)) * angle / radiance_scale);
            }
        }
        for (int n = 0; n <= top; ++n)
            for (int i = 0; i < q.levels[static_cast<std::size_t>(n)].cones; ++i)
                table.push_back(glm::vec4(glm::vec3(light[static_cast<std::size_t>(n)][static_cast<std::size_t>(i)]),
                                          static_cast<float>(hrc_cone_angle(n, climb, i))));
    }
    return table;
}

}  // namespace penumbra
