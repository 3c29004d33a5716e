// SPDX-License-Identifier: MIT
#include "core/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "core/device_error.h"
#include "core/plan/choose.h"
#include "core/plan/closed.h"
#include "core/plan/pack.h"
#include "core/plan/saving.h"
#include "core/plan/skip.h"
#include "core/plan/split_lights.h"
#include "core/plan/sky.h"
#include "core/scene/words.h"
#include "glsl/exact.h"
#include "glsl/jump.h"
#include "glsl/scene_records.h"
#include "glsl/surface_records.h"

namespace penumbra {
namespace {

// More outline than this is refused by the method `exact`.
constexpr std::size_t kMostPieces = 500'000;

// How far `exact` asks: half the diagonal of its largest cell, on both sides of an outline (glsl/exact_split.comp). Solved points, lights and
// the picture ask less: the sign, and how much of a pixel beside an outline it covers.
constexpr double kExactReachPx = 6;
static_assert(0.7072 * glsl::kExactCell + 0.01 < kExactReachPx);
// A bitmap's pixel that is not found is farther than that: the distance is to its edge.
static_assert(glsl::kNearSeeds + 1 - 0.5 > kExactReachPx);

// The composed picture leaves the device in bands of this size.
constexpr std::size_t kBandBytes = std::size_t(64) << 20;

// A loop in a branch that no invocation of a vector takes still counts once on Mesa 22: each shape costs an iteration of
// its own and one for each of the two loops over an outline's inside.
constexpr std::size_t kIterationsPerShape = 3;

// Above this, cascades are kept in half floats: two 4096 x 4096 textures in full floats are 512 MiB.
constexpr std::size_t kFullFloatBytes = std::size_t(320) << 20;

// How many loop iterations a ray makes at most: shapes, edges, and bitmap texels along it.
std::size_t tests_per_ray(const std::vector<Shape>& shapes) {
    std::size_t tests = 0;
    for (const Shape& shape : shapes) {
        tests += kIterationsPerShape + edge_count(shape);
        // A ray that meets it looks its place up.
        if (!shape.gradient.empty()) tests += edge_count(shape) + shape.gradient.size() + 2;
        if (const auto* bitmap = std::get_if<Bitmap>(&shape.geometry))
            tests += static_cast<std::size_t>(bitmap->image->width + bitmap->image->height + 2);
    }
    return std::max<std::size_t>(tests, 1);
}

// Of a ray on its way through media, as far as a dispatch is planned: a ray that meets more of them than this goes on.
std::size_t media_tests(const std::vector<Shape>& media) {
    std::size_t edges = 0;
    for (const Shape& shape : media) edges += 1 + std::max<std::size_t>(edge_count(shape), 1);
    return edges * std::min<std::size_t>(2 * edges, 16);
}

// `more`: tests at the end of a ray.
ReferencePlan plan_reference(const Scene& scene, const DeviceLimits& limits, std::size_t more) {
    ReferencePlan plan;
    plan.rays = reference_rays(scene.render.quality);
    plan.tests_per_ray = tests_per_ray(scene.shapes) + more;
    // Half of what Mesa 22 allows an invocation, since a loop's last test may count as well. Where no limit was found it
    // holds too: an invocation that runs for seconds costs a GPU its context.
    constexpr std::size_t kMost = 65535 / 2;
    const std::size_t most = limits.max_loop_iterations == 0 ? kMost : std::min(kMost, static_cast<std::size_t>(limits.max_loop_iterations) / 2);
    const std::size_t cost = 1 + plan.tests_per_ray;
    if (limits.max_loop_iterations != 0 && cost > most)
        throw DeviceError("The scene has too many edges for the method 'reference' on this device: a ray makes up to " +
                          std::to_string(plan.tests_per_ray) + " tests, and its loops end after " +
                          std::to_string(limits.max_loop_iterations) + " iterations.");
    plan.rays_per_dispatch = static_cast<int>(std::clamp<std::size_t>(most / cost, 1, static_cast<std::size_t>(plan.rays)));
    return plan;
}

bool light_bounces(const Scene& scene) {
    if (scene.render.bounces == 0) return false;
    return std::any_of(scene.shapes.begin(), scene.shapes.end(), [](const Shape& shape) { return reflects(shape); });
}

double brightest_emission(const Shape& shape) {
    if (const auto* bitmap = std::get_if<Bitmap>(&shape.geometry)) return bitmap->as_albedo ? 0.0 : bitmap->emission_scale;
    double peak = std::max({shape.emission.r, shape.emission.g, shape.emission.b});
    for (const EmissionStop& stop : shape.gradient) peak = std::max({peak, stop.emission.r, stop.emission.g, stop.emission.b});
    return peak;
}

// What a thick medium shines with.
double brightest_glow(const Medium& medium) {
    double most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, medium.extinction[c] > 0 ? std::min(medium.emission[c] / medium.extinction[c], medium.emission[c] * 1e4) : medium.emission[c] * 1e4);
    return most;
}

std::vector<ShapeSlice> slice_shapes(const std::vector<Shape>& shapes) {
    std::vector<ShapeSlice> slices;
    std::size_t spent = 0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const std::size_t cost = distance_iterations(static_cast<int>(shapes[i].geometry.index()), edge_count(shapes[i]));
        if (slices.empty() || spent + cost > kIterationsPerSlice) {
            slices.push_back({static_cast<int>(i), static_cast<int>(i)});
            spent = 0;
        }
        spent += cost;
        slices.back().end = static_cast<int>(i) + 1;
    }
    return slices;
}

// What hrc may hold at once. All levels of a quadrant's ray pieces are kept until they are merged, so it needs two to eleven
// times what rc does; more than this would push others out of a server's memory.
constexpr std::size_t kMostHrcBytes = std::size_t(3) << 30;
constexpr std::size_t kMostHrcBytesOnGpu = std::size_t(16) << 30;

std::size_t area(glm::ivec2 size) { return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y); }

void check_size(glm::ivec2 size, std::size_t texel_bytes, const DeviceLimits& limits, const char* what) {
    if (std::max(size.x, size.y) <= limits.max_texture_side && area(size) * texel_bytes <= limits.max_texture_bytes) return;
    throw DeviceError("The picture is too large for this device: its " + std::string(what) + " needs a texture of " +
                      std::to_string(size.x) + " x " + std::to_string(size.y) + ".");
}

HrcPlan hrc_of(const Scene& scene, glm::ivec2 canvas) {
    HrcPlan hrc = plan_hrc(canvas, scene.canvas.margin / scene.canvas.pixel_size(), hrc_settings(scene.render.quality));
    hrc.coloured = !scene.media.empty();
    return hrc;
}

// hrc: half floats where full ones would take more than the cascades of rc may; refused where those are too many as well.
bool hrc_fits(const Scene& scene, glm::ivec2 canvas, const DeviceLimits& limits) {
    const HrcPlan hrc = hrc_of(scene, canvas);
    for (const HrcQuadrant& q : hrc.quadrants)
        for (const HrcLevel& level : q.levels)
            if (std::max(q.rows, hrc.halves() * level.planes * level.rays) > limits.max_texture_side) return false;
    return hrc_bytes(hrc, 8) <= (limits.software ? kMostHrcBytes : kMostHrcBytesOnGpu);
}

void fit_hrc(Plan& plan, double peak, const DeviceLimits& limits) {
    plan.half_floats = hrc_bytes(plan.hrc, 16) > kFullFloatBytes;
    if (plan.half_floats) plan.radiance_scale = peak > 0 ? peak : 1.0;
    const std::size_t texel = plan.half_floats ? 8 : 16;
    for (const HrcQuadrant& q : plan.hrc.quadrants)
        for (const HrcLevel& level : q.levels) check_size({q.rows, plan.hrc.halves() * level.planes * level.rays}, texel, limits, "lattice");
    const std::size_t bytes = hrc_bytes(plan.hrc, texel);
    if (bytes > (limits.software ? kMostHrcBytes : kMostHrcBytesOnGpu))
        throw DeviceError("The picture is too large for the method 'hrc' on this device: it needs " + std::to_string(bytes >> 20) +
                          " MiB. A lower quality or the method 'rc' needs less.");
    plan.gpu_bytes += bytes;
}

// hybrid: a few lamps are solved as by `exact`, the rest is sampled as by `hrc`.
void plan_split(Plan& plan, const Scene& scene, const LightSplit& split, const DeviceLimits& limits) {
    plan.solved_shapes = split.solved;
    if (split.solved.empty()) return;
    const Scene part = solved_part(scene, split.solved);
    PackedOutline outline = pack_outline(part, 1.0, false, kMostPieces);
    if (!outline.fits)
        throw DeviceError("The method 'hybrid' cannot take this scene: the outline about the lamps that it solves has more than " +
                          std::to_string(kMostPieces) + " pieces.");
    outline.mean_intervals = split.cost / std::max(double(outline.pieces), 1.0);
    plan.exact = plan_exact(part, std::move(outline), plan.canvas, limits.software);
    if (split.all() && brightest(scene.sky) <= 0 && saves(scene.render, Saving::sampling)) plan.hrc = {};
}

}  // namespace

std::size_t distance_iterations(int type, std::size_t edges) {
    return kIterationsPerShape + edges + (type == glsl::kShapeEllipse ? static_cast<std::size_t>(glsl::kEllipseIterations) : 0);
}

int reference_rays(Quality quality) {
    switch (quality) {
        case Quality::draft: return 64;
        case Quality::standard: return 256;
        case Quality::high: return 1024;
    }
    return 256;
}

std::vector<int> plan_jumps(glm::ivec2 grid) {
    std::vector<int> steps;
    int step = 1;
    while (step * 2 < std::max(grid.x, grid.y)) step *= 2;
    for (; step >= 1; step /= 2) steps.push_back(step);
    steps.push_back(1);
    steps.push_back(1);
    return steps;
}

GridPlan plan_grid(const Canvas& canvas) {
    GridPlan grid;
    const double margin_px = canvas.margin / canvas.pixel_size();
    const int border = static_cast<int>(std::ceil(margin_px));
    grid.border = {border, border};
    grid.size = glm::ivec2(canvas.width, canvas.height) + 2 * grid.border;
    grid.domain = {-margin_px, -margin_px, canvas.width + margin_px, canvas.height + margin_px};
    grid.diagonal_px = std::hypot(canvas.width + 2 * margin_px, canvas.height + 2 * margin_px);
    return grid;
}

Plan make_plan(const Scene& scene, const DeviceLimits& limits, const std::string& not_exact) {
    Plan plan;
    plan.canvas = {scene.canvas.width, scene.canvas.height};
    plan.grid = plan_grid(scene.canvas);
    plan.method = scene.render.method;
    plan.method_reason = "asked for";
    const bool reflecting = light_bounces(scene);
    const FloorMaterial& floor = scene.canvas.floor;
    plan.floor = {!floor.is_plain(), floor.has_relief(), floor.gloss.has_value()};
    const PixelRect region = scene.canvas.region_or_all();
    plan.shown = {{region.x, region.y}, {region.w, region.h}};
    plan.lit.first = glm::max(plan.shown.first - 1, glm::ivec2(0));
    plan.lit.size = glm::min(plan.shown.end() + 1, plan.canvas) - plan.lit.first;
    // What these show depends on more than what is shown: a part stays what it is of the whole.
    if (scene.output.solids == Solids::lit || scene.output.auto_key || scene.render.view != "final") plan.lit = {{0, 0}, plan.canvas};
    const bool in_part = area(plan.lit.size) < area(plan.canvas);
    plan.end_distance_row = plan.grid.size.y;
    // What the picture depends on alone, so that its limits hold whatever is skipped.
    const std::size_t row_bytes = static_cast<std::size_t>(plan.shown.size.x) * (scene.output.format != "png" ? 16 : bit_depth_of("png", scene.output.bit_depth) / 2);
    // Linear pictures of 8192 x 8192 would be a GiB at once, more than llvmpipe holds in a texture.
    plan.band_rows = static_cast<int>(std::clamp<std::size_t>(kBandBytes / row_bytes, 1, static_cast<std::size_t>(plan.shown.size.y)));
    check_size(plan.grid.size, 4, limits, "distance field");
    const double pixels = double(area(plan.canvas));
    const double grid_pixels = double(area(plan.grid.size));
    // `render.skip: "none"` runs what the scene does not need as well, for comparison.
    const auto skip = [&](Saving saving) { return saves(scene.render, saving); };
    const auto leave_out = [&](std::string what, std::string why, double saved) {
        plan.skipped.push_back({std::move(what), std::move(why), saved});
    };
    // A view looks at what a constant picture has not, and dither differs from pixel to pixel.
    const bool may_be_constant = scene.render.view == "final" && (scene.output.dither == Dither::none || scene.output.format != "png");
    if (std::optional<ConstantLight> light = may_be_constant ? constant_light(scene) : std::nullopt) {
        if (plan.method == "auto") {
            plan.method = "exact";
            plan.method_reason = "every pixel is the same, whatever the method";
        }
        plan.constant = light->mean_radiance;
        leave_out("all passes", light->why, double(area(plan.shown.size)));
        return plan;
    }
    PackedOutline outline;
    LightSplit split;
    plan.needs.media = !scene.media.empty();
    plan.look = look_of(scene.render.view);
    plan.needs.steps = plan.look.at == LookAt::steps;
    const bool looks_inside = plan.look.at == LookAt::cascade || plan.look.at == LookAt::probes || plan.needs.steps;
    if (plan.method == "auto" && (looks_inside || plan.look.at == LookAt::skipped)) {
        plan.method = looks_inside || plan.needs.media ? "rc" : "exact";
        plan.method_reason = "what the view looks at";
    }
    if (plan.method == "auto" && plan.needs.media) {
        plan.method = hrc_fits(scene, plan.canvas, limits) ? "hrc" : "rc";
        plan.method_reason = plan.method == "hrc" ? "rays are weakened on their way through media" : "media, and too large a picture for hrc on this device";
    } else if (plan.method == "auto") {
        outline = pack_outline(scene, 1.0, true, most_surveyed_pieces(), reflecting);
        if (plan.floor.relief && !(outline.fits && not_exact.empty()))
            throw DeviceError("The scene is too dense for a floor with relief, which only the method 'exact' has: " +
                              (not_exact.empty() ? "its outline has more than " + std::to_string(most_surveyed_pieces()) + " pieces." : not_exact));
        MethodChoice choice = !not_exact.empty()            ? MethodChoice{"hrc", not_exact}
                                    : reflecting && outline.fits ? MethodChoice{"exact", "surfaces reflect"}
                                    : plan.floor.relief          ? MethodChoice{"exact", "the floor has relief"}
                                                                 : choose_method(outline, scene.render.quality);
        if (choice.method == "hrc" && outline.fits && not_exact.empty() && hrc_fits(scene, plan.canvas, limits)) {
            split = split_lights(scene, most_surveyed_pieces());
            choice = choose_split(split, outline, scene.render.quality, choice);
        }
        plan.method = choice.method;
        plan.method_reason = choice.reason;
        if (plan.method == "hrc" && !hrc_fits(scene, plan.canvas, limits)) {
            plan.method = "rc";
            plan.method_reason += "; too large a picture for hrc on this device";
        }
    } else if (plan.method == "exact") {
        outline = pack_outline(scene, 1.0, false, kMostPieces, reflecting);
        if (!outline.fits)
            throw DeviceError("The method 'exact' cannot take this scene: its outline has more than " +
                              std::to_string(kMostPieces) + " pieces.");
    } else if (plan.method == "hybrid") {
        split = split_lights(scene, kMostPieces);
        if (split.solved.empty() && !pack_outline(scene, 1.0, false, kMostPieces).fits)
            throw DeviceError("The method 'hybrid' cannot take this scene: its outline has more than " +
                              std::to_string(kMostPieces) + " pieces.");
        plan.method_reason += "; the brightest " + std::to_string(split.solved.size()) + " of " + std::to_string(split.lamps) + " lamps are solved";
    }
    const bool brute_force = plan.method == "reference";
    const bool exact = plan.method == "exact";
    plan.bilinear_fix = plan.method == "rc_fix";
    const bool hybrid = plan.method == "hybrid";
    const bool holographic = plan.method == "hrc" || hybrid;

    double peak = brightest(scene.sky);
    bool has_bitmaps = false;
    for (const Shape& shape : scene.shapes) {
        peak = std::max(peak, brightest_emission(shape));
        has_bitmaps = has_bitmaps || std::holds_alternative<Bitmap>(shape.geometry);
    }

    for (const Shape& shape : scene.media) peak = std::max(peak, brightest_glow(*shape.medium));
    if (skip(Saving::programs)) {
        plan.needs.general = plan.needs.ellipses = plan.needs.outlines = plan.needs.bitmaps = plan.needs.gradients = false;
        std::vector<Shape> all = scene.shapes;
        for (const Shape& shape : scene.media) all.push_back(shape);
        for (const Shape& shape : all) {
            const Geometry& g = shape.geometry;
            plan.needs.gradients = plan.needs.gradients || !shape.gradient.empty();
            plan.needs.ellipses = plan.needs.ellipses || std::holds_alternative<Ellipse>(g);
            plan.needs.outlines = plan.needs.outlines || std::holds_alternative<Polyline>(g) || std::holds_alternative<Polygon>(g);
            plan.needs.bitmaps = plan.needs.bitmaps || std::holds_alternative<Bitmap>(g);
        }
    }
    if (!plan.needs.general) {
        const int kinds = 3 - int(plan.needs.ellipses) - int(plan.needs.outlines) - int(plan.needs.bitmaps);
        const int curves = scene.output.format == "png" ? 5 : 0;
        if (kinds + curves > 0) leave_out("branches", "programs are made for the shapes and the tone curve that the scene has", kinds + curves);
    }
    plan.shape_slices = slice_shapes(scene.shapes);
    if (plan.shape_slices.empty()) {
        if (skip(Saving::distance))
            leave_out("distance pass", "the scene has no shapes: every distance is the diagonal", grid_pixels);
        else
            plan.shape_slices.push_back({0, 0});
    }
    if (exact && plan.look.at != LookAt::field && skip(Saving::reach)) plan.distance_reach_px = kExactReachPx;
    const bool limited = plan.distance_reach_px < kUnlimitedReach;
    plan.list_shapes = skip(Saving::lists) && scene.shapes.size() >= (limited ? 1 : kFewestListedShapes);
    const std::vector<int> jumps = plan_jumps(plan.grid.size);
    if (brute_force)
        leave_out("jump flooding", "rays meet bitmaps texel by texel", grid_pixels * double(jumps.size()));
    else if (!has_bitmaps && skip(Saving::flooding))
        leave_out("jump flooding", "the scene has no bitmaps", grid_pixels * double(jumps.size()));
    else if (has_bitmaps && limited) {
        plan.near_bitmaps = true;
        leave_out("jump flooding", "no pixel asks for a bitmap that is farther than " + std::to_string(glsl::kNearSeeds) + " px", grid_pixels * double(jumps.size()));
    } else
        plan.jump_steps = jumps;

    const CascadeSettings settings = plan.bilinear_fix ? rc_fix_settings(scene.render.quality) : cascade_settings(scene.render.quality);
    if (brute_force)
        plan.reference = plan_reference(scene, limits, (reflecting ? static_cast<std::size_t>(glsl::kMostSurfaceChords) : 0) + media_tests(scene.media));
    else if (exact)
        plan.exact = plan_exact(scene, std::move(outline), plan.canvas, limits.software);
    else if (holographic)
        plan.hrc = hrc_of(scene, plan.canvas);
    else
        plan.cascades = plan_cascades(plan.canvas, plan.grid.diagonal_px, settings);
    if (hybrid) {
        const double steps = double(plan.hrc.quadrants.front().levels.size());
        plan_split(plan, scene, split, limits);
        if (!plan.hrc.active()) leave_out("ray pieces", "all lamps are solved", pixels * steps);
    }
    if (reflecting && !exact) {
        // What surfaces shine with is solved, whatever the method; only what meets them is sampled.
        outline = pack_outline(scene, 1.0, false, kMostPieces, true);
        if (!outline.fits)
            throw DeviceError("The scene is too dense for bounces: its outline has more than " + std::to_string(kMostPieces) + " pieces.");
        plan.exact = plan_exact(scene, std::move(outline), plan.canvas, limits.software);
        plan.exact.used = false;
        plan.needs.surfaces = true;
    }
    plan.exact.moments = exact && plan.floor.relief;
    plan.exact.bounces = reflecting ? scene.render.bounces : 0;
    plan.exact.converged = scene.render.converged ? scene.render.tolerance : 0;
    if (scene.render.bounces > 0 && !reflecting) leave_out("bounces", "no surface reflects", double(scene.render.bounces));
    plan.delta.lights = pack_lights(scene);
    if (plan.delta.used() && !exact) {
        plan.delta.outline = pack_outline(scene, 1.0, false, kMostPieces);
        if (!plan.delta.outline.fits)
            throw DeviceError("The shadows of point, spot and directional lights need the scene's outline, which has more than " +
                              std::to_string(kMostPieces) + " pieces.");
    }
    // Lights without a size are added for themselves, but what they light may light other things.
    if (peak <= 0 && plan.delta.used() && plan.exact.bounces == 0 && skip(Saving::constant)) {
        const double levels = holographic ? double(plan.hrc.quadrants.front().levels.size()) : double(plan.cascades.size());
        const double rays = brute_force ? plan.reference.rays : exact ? 1.0 : (plan.bilinear_fix ? 16.0 : 4.0) * levels;
        leave_out(brute_force ? "rays" : exact ? "points" : holographic ? "ray pieces" : "cascades",
                  "nothing shines but lights without a size", pixels * rays);
        plan.cascades.clear();
        plan.reference = {};
        if (exact) plan.delta.outline = std::move(plan.exact.outline);
        plan.exact = {};
        plan.hrc = {};
    }
    // The beams of rc_fix's last cascade differ from the rays of those below it, so that another may not take its place.
    if (!plan.cascades.empty() && !plan.bilinear_fix && !plan.needs.media && !looks_inside && skip(Saving::levels)) {
        const bool dark_sky = brightest(scene.sky) <= 0;
        const double levels = static_cast<double>(leave_out_far(plan.cascades, extent_of_shapes(scene, dark_sky, reflecting), plan.grid.diagonal_px));
        if (levels > 0) leave_out("cascades", dark_sky ? "no light is as far away" : "no shape is as far away", 4.0 * pixels * levels / (settings.spacing_px * settings.spacing_px));
    }
    if ((exact || hybrid) && !skip(Saving::cells)) plan.exact.settings.largest_cell = 1;
    const bool resolved = settings.spacing_px == 1.0 && settings.base_tiles == 1;
    plan.resolve = !plan.cascades.empty() && !(resolved && skip(Saving::resolve));
    if (!plan.resolve && !plan.cascades.empty())
        leave_out("resolve", "cascade 0 is the mean radiance of each pixel", pixels);

    // Closed-off pixels are black, which they are as well where they count as solid: of a lamp without a size, or of a view, they are not.
    const std::vector<DarkRegion>& dark = plan.exact.outline.dark_regions;
    if (exact && !dark.empty() && !plan.delta.used() && scene.render.view == "final" && scene.output.solids == Solids::emission &&
        !scene.output.auto_key && skip(Saving::closed)) {
        plan.closed_tiles = tiles_within(dark, plan.canvas, glsl::kExactTile);
        const double closed = double(plan.closed_tiles.size()) * glsl::kExactTile * glsl::kExactTile;
        if (closed > 0) leave_out("closed-off pixels", "no light gets there", closed);
    }
    const bool interpolated = plan.hrc.active() ? !plan.hrc.aligned() : !plan.cascades.empty() && settings.spacing_px != 1.0;
    plan.lone = interpolated && !plan.shape_slices.empty();

    std::size_t largest_area = area(plan.canvas);
    for (const CascadePlan& c : plan.cascades) largest_area = std::max(largest_area, area(c.texture));
    plan.half_floats = (!plan.cascades.empty() || plan.exact.used) && largest_area * 16 > kFullFloatBytes;
    if (plan.half_floats) plan.radiance_scale = peak > 0 ? peak : 1.0;
    const std::size_t texel = plan.half_floats ? 8 : 16;
    if (in_part) {
        keep_probes_near(plan.cascades, plan.lit);
        largest_area = area(plan.lit.size);
        for (const CascadePlan& c : plan.cascades) largest_area = std::max(largest_area, area(c.texture));
        // Of the bands that are solved, every tile's corner is: their mean is what tolerances are relative to.
        if (exact && plan.jump_steps.empty()) {
            const int band = plan.exact.band_rows;
            const int beside = plan.near_bitmaps ? glsl::kNearSeeds : 0;
            plan.first_distance_row = std::max(plan.lit.first.y / band * band + plan.grid.border.y - beside, 0);
            plan.end_distance_row = std::min(std::min((plan.lit.end().y + band - 1) / band * band + 1, plan.canvas.y) + plan.grid.border.y + beside, plan.grid.size.y);
        }
    }
    for (const CascadePlan& c : plan.cascades) check_size(c.texture, texel, limits, "cascade");

    plan.gpu_bytes = 8 * area(plan.grid.size) + row_bytes * static_cast<std::size_t>(plan.band_rows);
    if (!plan.jump_steps.empty()) plan.gpu_bytes += 8 * area(plan.grid.size);
    if (plan.near_bitmaps) plan.gpu_bytes += 2 * area(plan.grid.size);
    if (!plan.cascades.empty()) plan.gpu_bytes += 2 * largest_area * texel;
    if (plan.reference.rays > 0) plan.gpu_bytes += 16 * area(plan.lit.size);
    if (plan.resolve) plan.gpu_bytes += area(plan.lit.size) * texel;
    if (plan.exact.used) plan.gpu_bytes += area(plan.lit.size) * texel + exact_bytes(plan.exact, plan.canvas);
    if (plan.delta.used()) plan.gpu_bytes += 16 * area(plan.lit.size);
    if (plan.exact.moments) plan.gpu_bytes += 2 * texel * area(plan.lit.size);
    if (plan.floor.used) plan.gpu_bytes += 16 * area(plan.lit.size) * (floor.normals ? 3 : floor.image ? 2 : 1);
    if (plan.hrc.active()) fit_hrc(plan, peak, limits);
    if (plan.hrc.active() && plan.exact.used) plan.gpu_bytes += 16 * area(plan.canvas);  // their sum
    for (glm::vec4& light : plan.exact.outline.lights_of)
        light = glm::vec4(glm::vec3(light) / static_cast<float>(plan.radiance_scale), light.a);
    for (std::size_t i = 0; i < plan.exact.outline.surfaces.materials.size(); ++i)
        if (i % glsl::kExactMaterialTexels != 2) plan.exact.outline.surfaces.materials[i] /= static_cast<float>(plan.radiance_scale);
    return plan;
}

}  // namespace penumbra
