// SPDX-License-Identifier: MIT
// What runs, at what size, and what the device is handed: arithmetic without a device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/device_error.h"
#include "core/plan/pack.h"
#include "core/plan/plan.h"
#include "core/plan/saving.h"
#include "core/plan/sky.h"
#include "core/plan/support.h"
#include "core/scene/limits.h"
#include "glsl/scene_records.h"

namespace penumbra {
namespace {

constexpr Quality kQualities[] = {Quality::draft, Quality::standard, Quality::high};
constexpr glm::ivec2 kSizes[] = {{1, 1},   {1, 8192}, {8192, 1},  {509, 257},   {7, 5},
                                 {300, 1}, {512, 512}, {2048, 64}, {8192, 8192}};

Scene scene_of(int width, int height) {
    Scene scene;
    scene.canvas.width = width;
    scene.canvas.height = height;
    return scene;
}

Shape shape_of(Geometry geometry, Colour emission = Colour(0)) {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.emission = emission;
    return shape;
}

Polygon star(int points) {
    Polygon polygon;
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        polygon.points.push_back({20 + 10 * std::cos(angle), 20 + 10 * std::sin(angle)});
    }
    return polygon;
}

std::vector<CascadePlan> cascades_for(double diagonal, double interval) {
    CascadeSettings settings;
    settings.interval_px = interval;
    return plan_cascades({64, 64}, diagonal, settings);
}

// ---- cascades -----------------------------------------------------------------------------------

TEST(PlanCascades, OfTheBilinearFixEndWhereRaysAreDenseEnough) {
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::high})
        for (const double diagonal : {1.4, 10.0, 136.0, 362.0, 724.0, 1448.0, 5793.0, 11585.0}) {
            const CascadeSettings settings = rc_fix_settings(quality);
            const auto cascades = plan_cascades({64, 64}, diagonal, settings);
            const auto gap = [&](const CascadePlan& c) { return 2 * std::numbers::pi * diagonal / c.directions(); };
            CascadeSettings all = settings;
            all.far_gap_px = 0;
            if (cascades.size() < plan_cascades({64, 64}, diagonal, all).size()) {
                EXPECT_LE(gap(cascades.back()), settings.far_gap_px);
            }
            if (cascades.size() > 1) {
                EXPECT_GT(gap(cascades[cascades.size() - 2]), settings.far_gap_px);
            }
            EXPECT_GE(cascades.back().end, diagonal);
            EXPECT_EQ(cascades[0].spacing, 1);
            EXPECT_EQ(cascades[0].probes, glm::ivec2(64));
            for (std::size_t c = 1; c < cascades.size(); ++c) {
                EXPECT_DOUBLE_EQ(cascades[c].spacing, cascades[c - 1].spacing * (c == 1 ? settings.growth : 2));
                EXPECT_NEAR(cascades[c].start, cascades[c - 1].end, 1e-9 * cascades[c].end);
            }
        }
}

TEST(PlanCascades, CountStandsOnBothSidesOfEveryPower) {
    for (const double interval : {0.5, 1.0, 1.2, 3.0})
        for (int n = 1; n <= 8; ++n) {
            // n cascades reach exactly this far.
            const double reach = interval * (std::pow(4.0, n) - 1) / 3;
            const auto count = static_cast<std::size_t>(n);
            EXPECT_EQ(cascades_for(reach * (1 - 1e-9), interval).size(), count) << reach;
            EXPECT_EQ(cascades_for(reach, interval).size(), count) << reach;
            EXPECT_EQ(cascades_for(reach * (1 + 1e-9), interval).size(), count + 1) << reach;
        }
}

TEST(PlanCascades, SixCascadesOfOnePixelAreTooFewForADiagonalOf2000) {
    // Errata E-10: "at most six" covers 1365 pixels.
    EXPECT_EQ(cascades_for(1365, 1).size(), 6u);
    EXPECT_EQ(cascades_for(2000, 1).size(), 7u);
}

TEST(PlanCascades, CoverTheDiagonalAndNeverOneTooMany) {
    for (const glm::ivec2 size : kSizes)
        for (const double margin : {0.0, 0.3, 100.0})
            for (const Quality quality : kQualities) {
                Canvas canvas;
                canvas.width = size.x;
                canvas.height = size.y;
                canvas.margin = margin;
                const double diagonal = plan_grid(canvas).diagonal_px;
                const auto cascades = plan_cascades(size, diagonal, cascade_settings(quality));
                ASSERT_FALSE(cascades.empty());
                EXPECT_GE(cascades.back().end, diagonal);
                if (cascades.size() > 1) {
                    EXPECT_LT(cascades[cascades.size() - 2].end, diagonal);
                }
            }
}

TEST(PlanCascades, IntervalsFollowOneAnotherAndQuadruple) {
    for (const Quality quality : kQualities) {
        const CascadeSettings settings = cascade_settings(quality);
        const auto cascades = plan_cascades({509, 257}, 571, settings);
        EXPECT_EQ(cascades[0].start, 0);
        EXPECT_DOUBLE_EQ(cascades[0].end, settings.interval_px);
        int sky_first = 0;
        for (std::size_t c = 0; c < cascades.size(); ++c) {
            EXPECT_EQ(cascades[c].level, static_cast<int>(c));
            EXPECT_DOUBLE_EQ(cascades[c].spacing, settings.spacing_px * std::pow(2.0, double(c)));
            EXPECT_EQ(cascades[c].directions(), 4 * settings.base_tiles * settings.base_tiles << 2 * c);
            EXPECT_EQ(cascades[c].sky_first, sky_first);
            sky_first += cascades[c].directions();
            if (c == 0) continue;
            EXPECT_NEAR(cascades[c].start, cascades[c - 1].end, 1e-9 * cascades[c].end);
            EXPECT_NEAR(cascades[c].end - cascades[c].start, 4 * (cascades[c - 1].end - cascades[c - 1].start),
                        1e-9 * cascades[c].end);
        }
    }
}

TEST(PlanCascades, ProbesAreCentredAndInsideTheViewAtEverySize) {
    for (const glm::ivec2 size : kSizes)
        for (const Quality quality : kQualities)
            for (const CascadePlan& c :
                 plan_cascades(size, std::hypot(size.x, size.y), cascade_settings(quality))) {
                EXPECT_EQ(c.texture, c.probes * c.tiles);
                for (int axis = 0; axis < 2; ++axis) {
                    const double first = c.first_probe[axis];
                    const double last = first + (c.probes[axis] - 1) * c.spacing;
                    EXPECT_GE(c.probes[axis], 1);
                    EXPECT_GT(first, 0) << size.x << "x" << size.y << " cascade " << c.level;
                    EXPECT_LT(last, size[axis]);
                    EXPECT_DOUBLE_EQ(first, size[axis] - last);
                    // No place of the view is farther from the grid than half a cell.
                    EXPECT_LE(first, 0.5 * c.spacing + 1e-9);
                }
            }
}

// ---- grid, jumps, slices ------------------------------------------------------------------------

TEST(PlanGrid, RoundsAFractionalMarginOutwards) {
    Canvas canvas;
    canvas.width = 40;
    canvas.height = 20;
    canvas.view = ViewRect{-3, 7, 10, 5};  // a pixel is a quarter unit
    canvas.margin = 0.6;                   // 2.4 pixels
    const GridPlan grid = plan_grid(canvas);
    EXPECT_EQ(grid.border, glm::ivec2(3, 3));
    EXPECT_EQ(grid.size, glm::ivec2(46, 26));
    EXPECT_DOUBLE_EQ(grid.domain.x0, -2.4);
    EXPECT_DOUBLE_EQ(grid.domain.y0, -2.4);
    EXPECT_DOUBLE_EQ(grid.domain.x1, 42.4);
    EXPECT_DOUBLE_EQ(grid.domain.y1, 22.4);
    EXPECT_DOUBLE_EQ(grid.diagonal_px, std::hypot(44.8, 24.8));
}

TEST(PlanGrid, WithoutAMarginIsTheCanvas) {
    Canvas canvas;
    canvas.width = 7;
    canvas.height = 5;
    const GridPlan grid = plan_grid(canvas);
    EXPECT_EQ(grid.border, glm::ivec2(0));
    EXPECT_EQ(grid.size, glm::ivec2(7, 5));
}

TEST(PlanJumps, HalveFromBelowTheLongerSideAndEndWithOneTwiceMore) {
    EXPECT_EQ(plan_jumps({8, 3}), (std::vector{4, 2, 1, 1, 1}));
    EXPECT_EQ(plan_jumps({3, 9}), (std::vector{8, 4, 2, 1, 1, 1}));
    EXPECT_EQ(plan_jumps({1, 1}), (std::vector{1, 1, 1}));
    for (const glm::ivec2 size : kSizes) {
        const std::vector<int> steps = plan_jumps(size);
        int reach = 0;
        for (std::size_t i = 0; i + 2 < steps.size(); ++i) reach += steps[i];
        EXPECT_GE(reach, std::max(size.x, size.y) - 1) << "a seed in one corner must reach the other";
    }
}

TEST(PlanSlices, CoverAllShapesOnceAndStayUnderTheLoopBound) {
    const DeviceLimits limits;
    Scene scene = scene_of(64, 64);
    for (int i = 0; i < 400; ++i) {
        scene.shapes.push_back(shape_of(Circle{{5, 5}, 2}, Colour(1)));
        scene.shapes.push_back(shape_of(star(3 + (i * 37) % 900)));
        Polyline line;
        line.points = star(2 + i).points;
        line.closed = i % 2 == 0;
        scene.shapes.push_back(shape_of(line));
        for (int k = 0; k < 20; ++k) scene.shapes.push_back(shape_of(Ellipse{{5, 5}, {2, 1}, 10}));
    }
    const Plan plan = make_plan(scene, limits);
    ASSERT_GT(plan.shape_slices.size(), 1u);
    int next = 0;
    for (const ShapeSlice& slice : plan.shape_slices) {
        EXPECT_EQ(slice.first, next);
        ASSERT_GT(slice.end, slice.first);
        next = slice.end;
        std::size_t iterations = 0;
        for (int i = slice.first; i < slice.end; ++i) {
            const Shape& shape = scene.shapes[static_cast<std::size_t>(i)];
            iterations += 1 + edge_count(shape);
            if (std::holds_alternative<Ellipse>(shape.geometry)) iterations += glsl::kEllipseIterations;
        }
        EXPECT_LT(iterations, static_cast<std::size_t>(limits.max_loop_iterations));
    }
    EXPECT_EQ(next, static_cast<int>(scene.shapes.size()));
}

TEST(PlanSlices, TheLargestPolygonIsASliceOfItsOwn) {
    Scene scene = scene_of(64, 64);
    const Limits limits;
    for (int i = 0; i < 3; ++i)
        scene.shapes.push_back(shape_of(star(static_cast<int>(limits.max_points_per_shape)), Colour(1)));
    EXPECT_EQ(make_plan(scene, {}).shape_slices.size(), 3u);
}

TEST(EdgeCount, OfEveryShape) {
    EXPECT_EQ(edge_count(shape_of(Circle{{0, 0}, 1})), 0u);
    EXPECT_EQ(edge_count(shape_of(Polygon{{{0, 0}, {1, 0}, {0, 1}}})), 3u);
    EXPECT_EQ(edge_count(shape_of(Polyline{{{0, 0}, {1, 0}, {0, 1}}, 1, false})), 2u);
    EXPECT_EQ(edge_count(shape_of(Polyline{{{0, 0}, {1, 0}, {0, 1}}, 1, true})), 3u);
    EXPECT_EQ(edge_count(shape_of(Polyline{{{0, 0}}, 1, false})), 1u);
}

// ---- the plan as a whole ------------------------------------------------------------------------

std::string skipped(const Plan& plan, const std::string& what) {
    for (const SkippedWork& work : plan.skipped)
        if (work.what == what) return work.why;
    return {};
}

TEST(MakePlan, SaysWhatItSkipsAndWhy) {
    Scene scene = scene_of(64, 48);
    scene.render.method = "exact";
    const Plan unlit = make_plan(scene, {});
    EXPECT_NE(skipped(unlit, "all passes").find("nothing emits"), std::string::npos);
    for (const SkippedWork& work : unlit.skipped) EXPECT_GT(work.saved, 0) << work.what;

    scene.render.method = "rc";
    const Plan empty = make_plan(scene, {});
    EXPECT_NE(skipped(empty, "all passes").find("nothing emits"), std::string::npos);
    EXPECT_TRUE(empty.cascades.empty());
    EXPECT_FALSE(empty.resolve);

    scene.render.keep = std::uint32_t(Saving::constant);
    const Plan dark = make_plan(scene, {});
    EXPECT_FALSE(dark.constant);
    EXPECT_NE(skipped(dark, "distance pass").find("no shapes"), std::string::npos);
    EXPECT_NE(skipped(dark, "jump flooding").find("no bitmaps"), std::string::npos);
    EXPECT_NE(skipped(dark, "cascades").find("no light"), std::string::npos);
    EXPECT_EQ(dark.cascades.size(), 1u);
    for (const SkippedWork& work : dark.skipped) EXPECT_GT(work.saved, 0) << work.what;
    scene.render.keep = 0;

    scene.shapes.push_back(shape_of(Circle{{5, 5}, 2}, Colour(0, 0, 1e-3)));
    const Plan lit = make_plan(scene, {});
    EXPECT_EQ(skipped(lit, "distance pass"), "");
    EXPECT_EQ(skipped(lit, "cascades"), "") << "the lamp is in a corner";
    EXPECT_NE(skipped(lit, "resolve"), "");
    EXPECT_FALSE(lit.cascades.empty());

    scene.render.quality = Quality::high;
    const Plan fine = make_plan(scene, {});
    EXPECT_TRUE(fine.resolve);
    EXPECT_EQ(skipped(fine, "resolve"), "");
}

TEST(MakePlan, ExactAsksForDistancesNearOutlinesOnly) {
    auto image = std::make_shared<Texels>();
    image->width = image->height = 1;
    image->rgba = {255, 255, 255, 255};
    Scene scene = scene_of(64, 48);
    scene.shapes.push_back(shape_of(Bitmap{image, {1, 1}, {4, 4}, 1, 0.5, false}));
    for (const char* method : {"exact", "rc", "rc_fix", "hrc", "hybrid"}) {
        scene.render.method = method;
        const bool exact = std::string(method) == "exact";
        const Plan plan = make_plan(scene, {});
        EXPECT_EQ(plan.distance_reach_px < kUnlimitedReach, exact) << method;
        EXPECT_EQ(plan.near_bitmaps, exact) << method;
        EXPECT_EQ(plan.jump_steps.empty(), exact) << method;
        EXPECT_EQ(plan.list_shapes, exact) << method << ": one shape";
    }
    // A view of the field, and a comparison, want all of it.
    scene.render.method = "exact";
    for (const char* view : {"distance", "normals", "tiles"}) {
        scene.render.view = view;
        EXPECT_EQ(make_plan(scene, {}).distance_reach_px, kUnlimitedReach) << view;
        EXPECT_FALSE(make_plan(scene, {}).near_bitmaps) << view;
    }
    scene.render.view = "final";
    scene.render.keep = static_cast<std::uint32_t>(Saving::reach);
    EXPECT_EQ(make_plan(scene, {}).jump_steps, plan_jumps({64, 48}));
    scene.render.keep = 0;
    // A part of the canvas asks the rows beside it as well, for bitmaps.
    scene = scene_of(64, 4000);
    scene.render.method = "exact";
    scene.shapes.push_back(shape_of(Bitmap{image, {1, 1}, {4, 4}, 1, 0.5, false}));
    scene.canvas.region = PixelRect{0, 3900, 10, 10};
    const Plan part = make_plan(scene, {});
    EXPECT_LE(part.first_distance_row, 3893);
    EXPECT_EQ(part.end_distance_row, 4000);
}

TEST(MakePlan, ABitmapIsFloodedAndItsLightCounts) {
    auto image = std::make_shared<Texels>();
    image->width = image->height = 1;
    image->rgba = {255, 255, 255, 255};
    Scene scene = scene_of(64, 48);
    scene.render.method = "rc";
    scene.shapes.push_back(shape_of(Bitmap{image, {1, 1}, {4, 4}, 1, 0.5, false}));
    EXPECT_EQ(make_plan(scene, {}).jump_steps, plan_jumps({64, 48}));
    EXPECT_FALSE(make_plan(scene, {}).cascades.empty());
    std::get<Bitmap>(scene.shapes[0].geometry).as_albedo = true;
    EXPECT_TRUE(make_plan(scene, {}).cascades.empty()) << "an albedo gives no light";
}

TEST(MakePlan, LargeCanvasesUseHalfFloatsWithEmissionScaled) {
    for (const char* method : {"rc", "exact"}) {
        Scene scene = scene_of(4096, 4096);
        scene.render.method = method;
        scene.sky.radiance = Colour(1, 40, 3);
        scene.shapes.push_back(shape_of(Circle{{500, 500}, 20}, Colour(10, 20, 0)));
        EXPECT_FALSE(make_plan(scene, {}).half_floats);
        EXPECT_EQ(make_plan(scene, {}).radiance_scale, 1);
        scene.canvas.width = scene.canvas.height = 8192;
        const Plan large = make_plan(scene, {});
        EXPECT_TRUE(large.half_floats);
        EXPECT_EQ(large.radiance_scale, 40);
        if (large.exact.used) {
            EXPECT_EQ(glm::vec3(large.exact.outline.lights_of.at(0)), glm::vec3(0.25f, 0.5f, 0));
        }
    }
}

TEST(MakePlan, RefusesWhatTheDeviceCannotHold) {
    Scene scene = scene_of(8192, 8192);
    scene.render.method = "rc";
    scene.sky.radiance = Colour(1);
    scene.shapes.push_back(shape_of(Circle{{5, 5}, 2}));
    EXPECT_NO_THROW(make_plan(scene, {}));
    scene.render.quality = Quality::high;
    try {
        make_plan(scene, {});
        FAIL() << "cascades of 16384 x 16384 do not fit";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("too large for this device"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("16384 x 16384"), std::string::npos) << error.what();
    }
    DeviceLimits small;
    small.max_texture_side = 1000;
    EXPECT_NO_THROW(make_plan(scene_of(1000, 10), small));
    EXPECT_THROW(make_plan(scene_of(1001, 10), small), DeviceError);
}

TEST(MakePlan, PicturesLeaveTheDeviceInBandsOfWholeRows) {
    Scene scene = scene_of(8192, 8192);
    scene.sky.radiance = Colour(1);
    scene.output.format = "pfm";
    const int rows = make_plan(scene, {}).band_rows;
    EXPECT_GE(rows, 1);
    EXPECT_LE(std::size_t(rows) * 8192 * 16, DeviceLimits().max_texture_bytes);
    EXPECT_EQ(make_plan(scene_of(7, 5), {}).band_rows, 5) << "no more than there are";
}

// ---- packing ------------------------------------------------------------------------------------

const glm::vec4& texel(const PackedScene& packed, int shape, int row) {
    return packed.shapes.at(static_cast<std::size_t>(shape * glsl::kShapeTexels + row));
}

TEST(Pack, EveryTypeInPixelsOfTheView) {
    Scene scene = scene_of(200, 100);
    scene.canvas.view = ViewRect{10, 20, 100, 50};  // two pixels a unit
    scene.shapes = {shape_of(Circle{{15, 25}, 3}, {2, 4, 8}),
                    shape_of(Ellipse{{15, 25}, {3, 4}, 90}),
                    shape_of(Rect{{15, 25}, {6, 8}, 180, 1}),
                    shape_of(Line{{15, 25}, {16, 27}, 3}),
                    shape_of(Polyline{{{15, 25}, {16, 27}, {12, 22}}, 3, true}),
                    shape_of(Polygon{{{15, 25}, {16, 27}, {12, 22}}})};
    auto image = std::make_shared<Texels>();
    image->width = 2;
    image->height = 1;
    image->rgba = {1, 2, 3, 4, 5, 6, 7, 8};
    scene.shapes.push_back(shape_of(Bitmap{image, {15, 25}, {4, 2}, 3, 0.5, false}));
    scene.shapes.push_back(shape_of(Bitmap{image, {15, 25}, {4, 2}, 3, 0.5, true}));
    const PackedScene packed = pack_scene(scene, 2);

    ASSERT_EQ(packed.shapes.size(), scene.shapes.size() * glsl::kShapeTexels);
    for (int i = 0; i < 7; ++i) EXPECT_EQ(texel(packed, i, 0).x, float(i)) << "types are numbered as the variant is";
    EXPECT_EQ(texel(packed, 0, 1), glm::vec4(1, 2, 4, 1));  // divided by the scale
    EXPECT_EQ(texel(packed, 0, 2), glm::vec4(10, 10, 6, 0));
    EXPECT_EQ(texel(packed, 1, 2), glm::vec4(10, 10, 6, 8));
    EXPECT_EQ(texel(packed, 1, 3), glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(texel(packed, 2, 2), glm::vec4(10, 10, 6, 8));  // half sizes
    EXPECT_EQ(texel(packed, 2, 3), glm::vec4(-1, 0, 2, 0));
    EXPECT_EQ(texel(packed, 3, 2), glm::vec4(10, 10, 12, 14));
    EXPECT_EQ(texel(packed, 3, 3).z, 3);  // half the width
    EXPECT_EQ(texel(packed, 4, 0), glm::vec4(4, 0, 0, 3));
    EXPECT_EQ(texel(packed, 4, 2), glm::vec4(4, 4, 12, 14));  // bounding box
    EXPECT_EQ(texel(packed, 4, 3).z, 3);
    EXPECT_EQ(texel(packed, 5, 0), glm::vec4(5, 0, 3, 3));
    ASSERT_EQ(packed.edges.size(), 6u);
    EXPECT_EQ(packed.edges[0], glm::vec4(10, 10, 12, 14));
    EXPECT_EQ(packed.edges[2], glm::vec4(4, 4, 10, 10));  // closed
    EXPECT_EQ(texel(packed, 6, 1).w, 1.5f);
    EXPECT_EQ(texel(packed, 6, 2), glm::vec4(10, 10, 8, 4));
    EXPECT_EQ(texel(packed, 6, 3).x, 0);
    EXPECT_EQ(texel(packed, 7, 1).w, 0) << "an albedo gives no light";
    EXPECT_EQ(texel(packed, 7, 3).x, 2) << "the second picture follows the first";
    ASSERT_EQ(packed.texels.size(), 4u);
    EXPECT_EQ(packed.texels[0], 0x04030201u);
    EXPECT_EQ(packed.bytes(), 16 * (packed.shapes.size() + 6) + 16);
}

TEST(Pack, KeepsItsPrecisionFarFromTheOriginAndAtAnySize) {
    for (const double offset : {0.0, 1e6, -1e6})
        for (const double side : {1e-3, 1.0, 1e6}) {
            Scene scene = scene_of(512, 512);
            scene.canvas.view = ViewRect{offset, offset, side, side};
            // At 0.3 of the view, as the format's doubles hold it.
            const double at = offset + 0.3 * side;
            scene.shapes = {shape_of(Circle{{at, at}, 0.01 * side}), shape_of(Rect{{at, at}, {0.1 * side, 0.2 * side}, 0, 0}),
                            shape_of(Polygon{{{at, at}, {at, offset}, {offset, at}}})};
            const PackedScene packed = pack_scene(scene, 1);
            const auto pixels = static_cast<double>((static_cast<long double>(at) - static_cast<long double>(offset)) /
                                                    static_cast<long double>(side) * 512);
            constexpr double kSingle = 1.2e-7;  // a float's relative precision
            EXPECT_NEAR(texel(packed, 0, 2).x, pixels, kSingle * pixels);
            EXPECT_NEAR(texel(packed, 0, 2).z, 5.12, kSingle * 5.12);
            EXPECT_NEAR(texel(packed, 1, 2).y, pixels, kSingle * pixels);
            EXPECT_NEAR(texel(packed, 1, 2).w, 51.2, kSingle * 51.2);
            EXPECT_NEAR(packed.edges.at(0).x, pixels, kSingle * pixels);
            EXPECT_NEAR(texel(packed, 2, 2).z, pixels, kSingle * pixels);
            EXPECT_EQ(texel(packed, 2, 2).x, 0);
        }
}

TEST(Pack, QuarterTurnsAreExact) {
    const glm::vec2 expected[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int quarters = -9; quarters <= 9; ++quarters) {
        Scene scene = scene_of(10, 10);
        scene.shapes = {shape_of(Rect{{5, 5}, {2, 4}, 90.0 * quarters, 0}), shape_of(Ellipse{{5, 5}, {2, 4}, 90.0 * quarters})};
        const PackedScene packed = pack_scene(scene, 1);
        for (int i = 0; i < 2; ++i)
            EXPECT_EQ(glm::vec2(texel(packed, i, 3)), expected[((quarters % 4) + 4) % 4]) << 90 * quarters;
    }
    Scene scene = scene_of(10, 10);
    scene.shapes = {shape_of(Rect{{5, 5}, {2, 4}, 30, 0})};
    const PackedScene packed = pack_scene(scene, 1);
    EXPECT_NEAR(texel(packed, 0, 3).x, std::sqrt(0.75), 1e-7);
    EXPECT_NEAR(texel(packed, 0, 3).y, 0.5, 1e-7);
}

TEST(Pack, ABitmapTexelIsSolidFromItsThresholdOn) {
    for (const double solid_above : {0.0, 1.0 / 255, 0.25, 0.5, 128.0 / 255, 0.999, 1.0}) {
        auto image = std::make_shared<Texels>();
        image->width = image->height = 1;
        image->rgba = {0, 0, 0, 0};
        Scene scene = scene_of(10, 10);
        scene.shapes = {shape_of(Bitmap{image, {0, 0}, {1, 1}, 1, solid_above, false})};
        const float threshold = texel(pack_scene(scene, 1), 0, 3).w;
        for (int alpha = 0; alpha < 256; ++alpha)
            EXPECT_EQ(float(alpha) / 255.0f >= threshold, alpha / 255.0 >= solid_above - 1e-12)
                << "alpha " << alpha << " above " << solid_above;
    }
}

TEST(Pack, ThinShapesAreFattenedAndTheirLightScaledDown) {
    Scene scene = scene_of(10, 10);
    scene.shapes = {shape_of(Circle{{5, 5}, 2}), shape_of(Line{{1, 1}, {9, 9}, 0.02}), shape_of(Circle{{5, 5}, 0.05})};
    const PackedScene packed = pack_scene(scene, 1);
    EXPECT_EQ(texel(packed, 0, 0).y, 0);
    EXPECT_EQ(texel(packed, 0, 1).w, 1);
    // A convex shape is seen as wide as its perimeter over pi (Cauchy): growing must not make it shine more.
    struct Thin {
        int shape;
        double half, perimeter;
    };
    constexpr double kTwoPi = 2 * std::numbers::pi;
    for (const auto& [shape, half, perimeter] : {Thin{1, 0.01, 2 * std::hypot(8, 8) + kTwoPi * 0.01}, Thin{2, 0.05, kTwoPi * 0.05}}) {
        const double fat = half + double(texel(packed, shape, 0).y);
        EXPECT_NEAR(fat, half + thin_shape_growth(half), 1e-7);
        EXPECT_GE(fat, 0.125) << "half of the shortest step";
        EXPECT_NEAR(double(texel(packed, shape, 1).w), perimeter / (perimeter + kTwoPi * (fat - half)), 1e-6);
    }
}

TEST(Pack, SliversOfPolygonsAreFattenedAndThickOnesAreNot) {
    Scene scene = scene_of(40, 40);
    scene.shapes = {shape_of(Polygon{{{1, 1}, {31, 1}, {31, 1.004}}}), shape_of(Polygon{{{1, 10}, {31, 10}, {31, 20}}})};
    const PackedScene packed = pack_scene(scene, 1);
    EXPECT_NEAR(texel(packed, 0, 0).y, 0.125, 2e-3);
    EXPECT_GT(texel(packed, 0, 1).w, 0.97f);
    EXPECT_EQ(texel(packed, 1, 0).y, 0);
    EXPECT_EQ(texel(packed, 1, 1).w, 1);
}

// ---- sky ----------------------------------------------------------------------------------------

Sky gradient_sky() {
    Sky sky;
    sky.gradient = {{20, {1, 0, 0}}, {100, {0, 2, 0}}, {100, {5, 5, 5}}, {230, {0, 0, 1}}, {300, {0.5, 0.25, 0}}};
    return sky;
}

Colour numeric_mean(const Sky& sky, double from, double to) {
    constexpr int kSteps = 40000;
    Colour sum(0);
    for (int i = 0; i < kSteps; ++i) sum += sky_radiance(sky, from + (to - from) * (i + 0.5) / kSteps);
    return sum / double(kSteps);
}

void expect_near(const Colour& a, const Colour& b, double bound, double at) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], bound) << "channel " << c << " at " << at;
}

TEST(Sky, IsLinearBetweenStopsAndWrapsRound) {
    const Sky sky = gradient_sky();
    expect_near(sky_radiance(sky, 20), {1, 0, 0}, 1e-12, 20);
    expect_near(sky_radiance(sky, 60), {0.5, 1, 0}, 1e-12, 60);
    expect_near(sky_radiance(sky, 165), {2.5, 2.5, 3}, 1e-12, 165);
    // From 300 on to 20 of the next turn: 80 degrees.
    expect_near(sky_radiance(sky, 340), {0.75, 0.125, 0}, 1e-12, 340);
    expect_near(sky_radiance(sky, 0), {0.875, 0.0625, 0}, 1e-12, 0);
    for (const double angle : {-400.0, -1.0, 365.0, 1000.0})
        expect_near(sky_radiance(sky, angle), sky_radiance(sky, angle - 360 * std::floor(angle / 360)), 1e-12, angle);
}

TEST(Sky, EqualAnglesMakeAStep) {
    const Sky sky = gradient_sky();
    expect_near(sky_radiance(sky, 100 - 1e-9), {0, 2, 0}, 1e-9, 100);
    expect_near(sky_radiance(sky, 100), {5, 5, 5}, 1e-12, 100);
}

TEST(Sky, MeansAreTheIntegral) {
    const Sky sky = gradient_sky();
    // Sampling at 40000 places errs by at most the step's height over twice that.
    for (const auto& [from, to] : {std::pair(0.0, 360.0), std::pair(30.0, 31.0), std::pair(90.0, 110.0),
                                   std::pair(290.0, 400.0), std::pair(-50.0, 50.0), std::pair(725.0, 1000.0)})
        expect_near(sky_mean(sky, from, to), numeric_mean(sky, from, to), 2e-4, from);
}

TEST(Sky, SectorsAreMeansAndAverageToTheWhole) {
    const Sky sky = gradient_sky();
    for (const int sectors : {1, 4, 7, 64, 4096}) {
        const std::vector<Colour> means = sky_sectors(sky, sectors);
        ASSERT_EQ(means.size(), static_cast<std::size_t>(sectors));
        Colour sum(0);
        for (int k = 0; k < sectors; ++k) {
            const Colour& mean = means[static_cast<std::size_t>(k)];
            sum += mean;
            if (sectors <= 64) expect_near(mean, sky_mean(sky, 360.0 * k / sectors, 360.0 * (k + 1) / sectors), 1e-9, k);
        }
        expect_near(sum / double(sectors), sky_mean(sky, 0, 360), 1e-9, sectors);
    }
}

TEST(Sky, WithoutAGradientIsConstant) {
    Sky sky;
    sky.radiance = {1, 2, 3};
    expect_near(sky_radiance(sky, 77), {1, 2, 3}, 0, 77);
    expect_near(sky_mean(sky, 10, 20), {1, 2, 3}, 0, 10);
    expect_near(sky_sectors(sky, 4)[3], {1, 2, 3}, 0, 3);
    EXPECT_EQ(brightest(sky), 3);
    EXPECT_EQ(brightest(gradient_sky()), 5);
}

TEST(Sky, OneStopIsConstant) {
    Sky sky;
    sky.gradient = {{350, {1, 2, 3}}};
    for (const double angle : {0.0, 350.0, 359.9}) expect_near(sky_radiance(sky, angle), {1, 2, 3}, 1e-12, angle);
    expect_near(sky_mean(sky, 0, 360), {1, 2, 3}, 1e-12, 0);
}

// ---- what is not built yet ----------------------------------------------------------------------

TEST(Unsupported, NothingInAPlainScene) { EXPECT_TRUE(unsupported(scene_of(8, 8)).empty()); }

TEST(Unsupported, NamesEachKeyAndWhatItHolds) {
    const auto expect_refused = [](const char* pointer, const char* named, auto change) {
        Scene scene = scene_of(8, 8);
        change(scene);
        const Problems problems = unsupported(scene);
        ASSERT_EQ(problems.size(), 1u) << pointer;
        EXPECT_EQ(problems[0].pointer, pointer);
        EXPECT_EQ(problems[0].code, "not_supported_yet");
        EXPECT_NE(problems[0].message.find("not supported"), std::string::npos) << problems[0].message;
        EXPECT_NE(problems[0].message.find(named), std::string::npos) << problems[0].message;
    };
    expect_refused("/render/method", "'hybrid'", [](Scene& s) {
        s.render.method = "hybrid";
        s.shapes.emplace_back().medium = Medium{};
    });
    expect_refused("/render/view", "'probes'", [](Scene& s) {
        s.render.view = "probes";
        s.render.method = "exact";
    });
    expect_refused("/render/view", "light4", [](Scene& s) { s.render.view = "light4"; });
    expect_refused("/output/tonemap", "'tony'", [](Scene& s) { s.output.tonemap = "tony"; });
}

TEST(Unsupported, NamesAllAtOnce) {
    Scene scene = scene_of(8, 8);
    scene.render.method = "exact";
    scene.render.view = "probes";
    scene.output.tonemap = "tony";
    EXPECT_EQ(unsupported(scene).size(), 2u);
    EXPECT_EQ(unsupported(scene, {.tone_lut = true}).size(), 1u);
}

}  // namespace
}  // namespace penumbra
