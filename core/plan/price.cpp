// SPDX-License-Identifier: MIT
#include "core/plan/price.h"

#include <algorithm>

#include "core/plan/choose.h"
#include "core/plan/pack_outline.h"
#include "core/plan/plan.h"
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

// Outlines that cross are cut at every crossing, of which there can be as many as pairs of edges.
constexpr std::size_t kMostEdges = 4000;
constexpr double kMostTexels = 512.0 * 512.0;

double area(glm::ivec2 size) { return double(size.x) * double(size.y); }

std::size_t edges_of(const Shape& shape) {
    if (const auto* line = std::get_if<Polyline>(&shape.geometry)) return line->points.size();
    if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) return polygon->points.size();
    return 1;
}

std::size_t edges_of(const Scene& scene) {
    std::size_t edges = 0;
    for (const Shape& shape : scene.shapes) edges += edges_of(shape);
    return edges;
}

double texels_of(const Scene& scene) {
    double texels = 0;
    for (const Shape& shape : scene.shapes) {
        const auto* bitmap = std::get_if<Bitmap>(&shape.geometry);
        if (bitmap && bitmap->image) texels += double(bitmap->image->width) * bitmap->image->height;
    }
    return texels;
}

double cpu_ms_of(const Price& price) {
    double ms = 0;
    for (std::size_t i = 0; i < kWorkKinds; ++i) ms += price.work[i] * kRows[i].cpu_us / 1000;
    return ms;
}

// As if it were sampled by `hrc`, which `auto` takes where there is much.
Price guess_of(const Scene& scene) {
    constexpr double kPiecesOfPixel = 160, kStepsOfFlooding = 12;
    Price price;
    price.planned = false;
    price.method = scene.render.method;
    price.method_reason = "too large to be looked at before its turn";
    const PixelRect shown = scene.canvas.region_or_all();
    price.size = {shown.w, shown.h};
    const double pixels = double(scene.canvas.width) * scene.canvas.height;
    const GridPlan grid = plan_grid(scene.canvas);
    const auto set = [&](Work work, double amount) { price.work[static_cast<std::size_t>(work)] = amount; };
    set(Work::render, 1);
    set(Work::pixels, pixels);
    set(Work::grid_pixels, area(grid.size));
    set(Work::shape_edges, double(edges_of(scene)));
    if (texels_of(scene) > 0) set(Work::flood_pixels, area(grid.size) * kStepsOfFlooding);
    if (price.method == "reference")
        set(Work::tests, pixels * reference_rays(scene.render.quality) * double(edges_of(scene)));
    else
        set(Work::ray_pieces, pixels * kPiecesOfPixel);
    price.cpu_ms = cpu_ms_of(price);
    return price;
}

}  // namespace

const char* name_of(Work work) { return kRows[static_cast<std::size_t>(work)].name; }

Price price_of(const Scene& given, const DeviceLimits& limits) {
    Scene made;
    if (needs_lowering(given)) made = lowered(given);
    const Scene& asked = needs_lowering(given) ? made : given;
    if (edges_of(asked) > kMostEdges || texels_of(asked) > kMostTexels) return guess_of(asked);
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
        // A window's three passes over the tiles near bitmaps take what a jump takes.
        add(Work::flood_pixels, area(plan.grid.size) * double(plan.jump_steps.size() + (plan.near_bitmaps ? 1 : 0)));
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
        }
        // Also of the methods that sample: what surfaces shine with is solved for all of them.
        if (plan.exact.bounces > 0) add(Work::bounced, double(plan.exact.outline.pieces) * double(plan.exact.bounces));
        add(Work::light_tests, lit * double(plan.delta.lights.size()));
    }
    price.cpu_ms = cpu_ms_of(price);
    return price;
}

}  // namespace penumbra
