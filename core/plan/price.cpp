// SPDX-License-Identifier: MIT
#include "core/plan/price.h"

#include <algorithm>

#include "core/plan/choose.h"
#include "core/plan/pack_outline.h"
#include "core/plan/skip.h"
#include "core/plan/support.h"
#include "core/scene/lower.h"

namespace penumbra {
namespace {

struct Row {
    const char* name;
    double cpu_us;  // of a unit
};

// By scripts/prices: least squares of relative errors over scenes, methods, qualities and two sizes, llvmpipe on Mesa 22.
constexpr std::array<Row, kWorkKinds> kRows{{
    {"render", 500},
    {"grid_pixels", 0.296},
    {"flood_pixels", 0.0898},
    {"shape_edges", 94.7},
    {"rays", 0.106},
    {"fixed_rays", 0.156},
    {"tests", 0.0117},
    {"ray_pieces", 0.0298},
    {"pixels", 0.001},
    {"seen", 0.00658},
    {"asked", 0.000138},
    {"pieces", 408},
    {"light_tests", 0.0465},
    {"bounced", 932},
}};

double area(glm::ivec2 size) { return double(size.x) * double(size.y); }

std::size_t edges_of(const Shape& shape) {
    if (const auto* line = std::get_if<Polyline>(&shape.geometry)) return line->points.size();
    if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) return polygon->points.size();
    return 1;
}

}  // namespace

const char* name_of(Work work) { return kRows[static_cast<std::size_t>(work)].name; }

Price price_of(const Scene& given, const DeviceLimits& limits) {
    Scene made;
    if (needs_lowering(given)) made = lowered(given);
    const Scene& asked = needs_lowering(given) ? made : given;
    std::vector<SkippedWork> skipped;
    const std::optional<Scene> lean = without_unseen_shapes(asked, skipped);
    const Scene& scene = lean ? *lean : asked;
    const Plan plan = make_plan(scene, limits);
    Price price;
    price.method = plan.method;
    price.method_reason = plan.method_reason;
    price.size = plan.shown.size;
    price.device_bytes = plan.gpu_bytes;
    const auto add = [&](Work work, double amount) { price.work[static_cast<std::size_t>(work)] += amount; };
    add(Work::render, 1);
    add(Work::pixels, area(plan.shown.size));
    if (!plan.constant) {
        const double rows = double(plan.end_distance_row - plan.first_distance_row);
        const double lit = area(plan.lit.size);
        if (!plan.shape_slices.empty()) add(Work::grid_pixels, double(plan.grid.size.x) * rows);
        add(Work::flood_pixels, area(plan.grid.size) * double(plan.jump_steps.size()));
        for (const Shape& shape : scene.shapes) add(Work::shape_edges, double(edges_of(shape)));
        add(Work::pixels, lit);
        for (const CascadePlan& cascade : plan.cascades)
            add(plan.bilinear_fix ? Work::fixed_rays : Work::rays, 4 * area(cascade.texture));
        if (plan.reference.rays > 0)
            add(Work::tests, lit * double(plan.reference.rays) * double(std::max<std::size_t>(plan.reference.tests_per_ray, 1)));
        for (const HrcQuadrant& quadrant : plan.hrc.quadrants) {
            for (const HrcLevel& level : quadrant.levels)
                add(Work::ray_pieces, double(level.pieces(quadrant.rows)) + double(level.planes) * double(level.cones) * double(quadrant.rows));
        }
        if (plan.exact.used) {
            // Asked for by name it is planned without the survey.
            PackedOutline outline;
            const bool surveyed = plan.exact.outline.mean_intervals > 0;
            if (!surveyed) outline = pack_outline(scene, 1.0, true, most_surveyed_pieces());
            const double intervals = surveyed ? plan.exact.outline.mean_intervals : outline.mean_intervals;
            const double pieces = double(plan.exact.outline.pieces);
            // Cells whose corners tell all of them are filled in; the tolerance decides how many are not.
            add(Work::seen, lit * intervals);
            add(Work::asked, lit * intervals * pieces);
            add(Work::pieces, pieces);
            add(Work::bounced, pieces * double(plan.exact.bounces));
        }
        add(Work::light_tests, lit * double(plan.delta.lights.size()));
    }
    for (std::size_t i = 0; i < kWorkKinds; ++i) price.cpu_ms += price.work[i] * kRows[i].cpu_us / 1000;
    return price;
}

}  // namespace penumbra
