// SPDX-License-Identifier: MIT
#include "tests/gpu/cascade_twin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/plan/sky.h"
#include "tests/support/sdf.h"

namespace penumbra::test {
namespace {

using glm::dvec2;

enum class Fate { passed, blocked, left };

struct Interval {
    Fate fate = Fate::passed;
    Colour radiance{0};
};

double exit_of(dvec2 p, dvec2 d, const PixelBox& box) {
    double leave = 1e300;
    if (d.x != 0) leave = std::min(leave, ((d.x > 0 ? box.x1 : box.x0) - p.x) / d.x);
    if (d.y != 0) leave = std::min(leave, ((d.y > 0 ? box.y1 : box.y0) - p.y) / d.y);
    return leave;
}

Interval trace(const Scene& scene, const Plan& plan, dvec2 p, dvec2 d, double start, double end) {
    const double leave = exit_of(p, d, plan.grid.domain);
    const double stop = std::min(end, leave);
    for (double t = start; t < stop;) {
        const FieldValue field = exact_field(scene.shapes, p + d * t, plan.grid.diagonal_px);
        if (field.distance <= 1e-7) return {Fate::blocked, scene.shapes[static_cast<std::size_t>(field.shape)].emission};
        t += field.distance;
    }
    return {leave <= end ? Fate::left : Fate::passed, Colour(0)};
}

struct Sample {
    Colour radiance{0};
    double weight = 0;
};

// Bilinear within one tile, clamped to its probes.
Sample interpolate(const CascadePlan& plan, const TwinCascade& cascade, int tile, dvec2 p) {
    const dvec2 probe = (p - plan.first_probe) / plan.spacing;
    const glm::ivec2 corner((tile % plan.tiles.x) * plan.probes.x, (tile / plan.tiles.x) * plan.probes.y);
    const dvec2 base(std::floor(probe.x), std::floor(probe.y));
    Sample sum;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const int x = std::clamp(static_cast<int>(base.x) + dx, 0, plan.probes.x - 1);
            const int y = std::clamp(static_cast<int>(base.y) + dy, 0, plan.probes.y - 1);
            const double wx = dx == 0 ? 1 - (probe.x - base.x) : probe.x - base.x;
            const double wy = dy == 0 ? 1 - (probe.y - base.y) : probe.y - base.y;
            const std::size_t i = cascade.index(corner.x + x, corner.y + y);
            sum.radiance += wx * wy * cascade.radiance[i];
            sum.weight += wx * wy * cascade.weight[i];
        }
    return sum;
}

}  // namespace

std::vector<TwinCascade> twin_cascades(const Scene& scene, const Plan& plan) {
    std::vector<TwinCascade> all(plan.cascades.size());
    for (std::size_t level = all.size(); level-- > 0;) {
        const CascadePlan& c = plan.cascades[level];
        TwinCascade& out = all[level];
        out.size = c.texture;
        out.radiance.resize(std::size_t(c.texture.x) * std::size_t(c.texture.y), Colour(0));
        out.weight.resize(out.radiance.size(), 0);
        const double sector = 360.0 / c.directions();
        for (int y = 0; y < c.texture.y; ++y)
            for (int x = 0; x < c.texture.x; ++x) {
                const dvec2 p = c.first_probe + dvec2(x % c.probes.x, y % c.probes.y) * c.spacing;
                if (exact_field(scene.shapes, p, 1e9).distance <= 0) continue;
                const int group = y / c.probes.y * c.tiles.x + x / c.probes.x;
                Colour sum(0);
                for (int direction = 4 * group; direction < 4 * group + 4; ++direction) {
                    const double angle = (direction + 0.5) * sector * std::numbers::pi / 180;
                    Interval ray = trace(scene, plan, p, {std::cos(angle), std::sin(angle)}, c.start, c.end);
                    const bool last = level + 1 == all.size();
                    if (ray.fate == Fate::left || (ray.fate == Fate::passed && last)) {
                        ray.radiance = sky_mean(scene.sky, direction * sector, (direction + 1) * sector);
                    } else if (ray.fate == Fate::passed) {
                        const Sample above = interpolate(plan.cascades[level + 1], all[level + 1], direction, p);
                        if (above.weight > 0) ray.radiance = above.radiance / above.weight;
                    }
                    sum += ray.radiance;
                }
                out.radiance[out.index(x, y)] = sum / 4.0;
                out.weight[out.index(x, y)] = 1;
            }
    }
    return all;
}

std::vector<Colour> twin_resolve(const Plan& plan, const TwinCascade& nearest) {
    const CascadePlan& c = plan.cascades.front();
    std::vector<Colour> result;
    for (int y = 0; y < plan.canvas.y; ++y)
        for (int x = 0; x < plan.canvas.x; ++x) {
            Sample sum;
            for (int tile = 0; tile < c.tiles.x * c.tiles.y; ++tile) {
                const Sample one = interpolate(c, nearest, tile, {x + 0.5, y + 0.5});
                sum.radiance += one.radiance;
                sum.weight += one.weight;
            }
            result.push_back(sum.weight > 0 ? sum.radiance / sum.weight : Colour(0));
        }
    return result;
}

}  // namespace penumbra::test
