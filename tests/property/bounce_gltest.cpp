// SPDX-License-Identifier: MIT
// Light that surfaces reflect: closed forms first, then the exact solver on the processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "core/compare/error_figures.h"
#include "core/reference/solver.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr double kPi = std::numbers::pi;

Shape mirror(Geometry geometry, Colour albedo, Colour emission = Colour(0)) {
    Shape result = shape(std::move(geometry), emission);
    result.albedo = albedo;
    return result;
}

Scene bouncing(Scene scene, int bounces, Quality quality = Quality::standard) {
    scene.render.bounces = bounces;
    scene.render.quality = quality;
    return scene;
}

// A room of four walls that all shine and reflect alike.
Scene furnace(double emission, double albedo) {
    Scene scene = canvas(48, 40);
    scene.output.antialias = false;
    const auto wall = [&](Point at, Point size) { scene.shapes.push_back(mirror(Rect{at, size, 0, 0}, Colour(albedo), Colour(emission))); };
    wall({24, 2}, {48, 4});
    wall({24, 38}, {48, 4});
    wall({2, 20}, {4, 40});
    wall({46, 20}, {4, 40});
    return scene;
}

ErrorFigures against_truth(const Scene& scene) {
    reference::Solution truth = reference::solve(scene);
    EXPECT_TRUE(truth.problems.empty());
    return std::get<ErrorFigures>(error_figures(render_linear(scene), truth.image));
}

TEST(Bounces, AClosedFurnaceIsTheGeometricSum) {
    for (const int bounces : {0, 1, 2, 7}) {
        const ImageF picture = render_linear(bouncing(furnace(0.5, 0.6), bounces));
        double expected = 0;
        for (int i = 0; i <= bounces; ++i) expected += 0.5 * std::pow(0.6, i);
        for (int y = 5; y < 35; ++y)
            for (int x = 5; x < 43; ++x) ASSERT_NEAR(picture.at(x, y)[1], expected, 2e-4 * expected) << bounces << " at " << x << ", " << y;
    }
}

TEST(Bounces, WhiteBodiesVanishUnderAWhiteSky) {
    // What is white and convex gives back the sky that it hides.
    const Geometry geometries[] = {Circle{{24.3, 20.1}, 9}, Ellipse{{24, 20}, {14, 6}, 33}, Rect{{24, 20}, {19, 9}, 20, 0},
                                   Rect{{24, 20}, {19, 9}, 20, 3}, Line{{15, 18}, {33, 22}, 6}, Polygon{{{12, 30}, {24, 8}, {37, 29}}}};
    for (const Geometry& geometry : geometries) {
        Scene scene = with(canvas(48, 40), {mirror(geometry, Colour(1))});
        scene.sky.radiance = Colour(0.5, 1, 2);
        const ImageF picture = render_linear(bouncing(scene, 1));
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 48; ++x)
                if (picture.at(x, y)[1] != 0) {
                    ASSERT_NEAR(picture.at(x, y)[2], 2, 1e-4) << geometry.index() << " at " << x << ", " << y;
                }
    }
}

// One piece of everything, in half a room, with colours.
Scene half_a_room() {
    Scene scene = canvas(96, 80);
    scene.canvas.margin = 10;
    scene.output.antialias = false;
    scene.sky.radiance = Colour(0.02, 0.03, 0.05);
    scene.shapes = {mirror(Rect{{48, 77}, {104, 6}, 0, 0}, {0.8, 0.7, 0.6}), mirror(Rect{{3, 40}, {6, 80}, 0, 0}, {0.8, 0.1, 0.1}),
                    mirror(Rect{{40, 55}, {18, 14}, 25, 4}, Colour(0.7)),    mirror(Ellipse{{70, 60}, {12, 6}, -30}, {0.3, 0.4, 0.9}),
                    mirror(Circle{{72, 30}, 6}, Colour(0.9)),               mirror(Polyline{{{20, 20}, {30, 30}, {20, 40}}, 2.5, false}, Colour(0.5)),
                    mirror(Circle{{45, 15}, 4}, Colour(0.3), {3, 2.5, 2})};
    return scene;
}

TEST(Bounces, ComeNearTheExactSolver) {
    struct Case {
        Quality quality;
        double rel, max, bias;
    };
    for (const Case& c : {Case{Quality::draft, 1e-2, 0.4, 5e-3}, Case{Quality::standard, 4e-3, 0.2, 1e-3}, Case{Quality::high, 1e-3, 0.03, 3e-4}}) {
        const ErrorFigures e = against_truth(bouncing(half_a_room(), 2, c.quality));
        std::printf("quality %d: rel %.2e max %.2e bias %+.2e\n", int(c.quality), *e.rel, *e.max, *e.bias);
        EXPECT_LT(*e.rel, c.rel) << int(c.quality);
        EXPECT_LT(*e.max, c.max) << int(c.quality);
        EXPECT_LT(std::abs(*e.bias), c.bias) << int(c.quality);
    }
}

TEST(Bounces, OfLightsWithoutASizeComeNearTheExactSolver) {
    Scene scene = half_a_room();
    scene.lights = {PointLight{{20.3, 60.2}, {10, 8, 6}}, SpotLight{{80, 12}, 130, 10, 25, {20, 30, 40}}, DirectionalLight{100, {0.3, 0.2, 0.1}}};
    const ErrorFigures e = against_truth(bouncing(scene, 2, Quality::high));
    std::printf("rel %.2e max %.2e bias %+.2e\n", *e.rel, *e.max, *e.bias);
    EXPECT_LT(*e.rel, 2e-3);
    EXPECT_LT(std::abs(*e.bias), 1e-3);
    // Nothing else shines: what surfaces send all comes from these lights.
    scene.shapes.back().emission = Colour(0);
    scene.sky.radiance = Colour(0);
    const ErrorFigures alone = against_truth(bouncing(scene, 1, Quality::high));
    EXPECT_LT(*alone.rel, 5e-3);
}

TEST(Bounces, AViewTenTimesAsLargeIsTheSamePicture) {
    const Scene small = bouncing(half_a_room(), 1);
    Scene large = small;
    large.canvas.view = ViewRect{0, 0, 960, 800};
    large.canvas.margin = 100;
    for (Shape& one : large.shapes) {
        if (auto* rect = std::get_if<Rect>(&one.geometry)) *rect = {rect->center * 10.0, rect->size * 10.0, rect->rotation_deg, rect->corner_radius * 10};
        if (auto* circle = std::get_if<Circle>(&one.geometry)) *circle = {circle->center * 10.0, circle->radius * 10};
        if (auto* ellipse = std::get_if<Ellipse>(&one.geometry)) *ellipse = {ellipse->center * 10.0, ellipse->radii * 10.0, ellipse->rotation_deg};
        if (auto* line = std::get_if<Polyline>(&one.geometry)) {
            for (Point& p : line->points) p *= 10.0;
            line->width *= 10;
        }
    }
    EXPECT_LT(difference(render_linear(small), render_linear(large)).max, 2e-3);
}

TEST(Bounces, ConvergedEndsWhereMoreWouldNotChangeIt) {
    Scene scene = bouncing(furnace(0.5, 0.5), 256);
    scene.render.converged = true;
    scene.render.tolerance = 1e-4;
    RenderResult result = shared_renderer().render(scene);
    const ImageF& picture = std::get<ImageF>(result.picture);
    EXPECT_NEAR(picture.at(24, 20)[0], 1.0, 4e-4);
    std::uint64_t dispatches = 0;
    for (const PassStats& pass : result.stats.passes)
        if (pass.name == "bounce") dispatches = pass.dispatches;
    EXPECT_GT(dispatches, 5u);
    EXPECT_LT(dispatches, 40u);
}

TEST(Bounces, NothingIsDoneWhereNothingReflects) {
    Scene scene = with(canvas(32, 24), {shape(Circle{{10, 10}, 3}, Colour(1)), shape(Rect{{22, 12}, {4, 10}, 0, 0})});
    const ImageF plain = render_linear(scene);
    scene.render.bounces = 5;
    const RenderResult result = shared_renderer().render(scene);
    EXPECT_EQ(std::get<ImageF>(result.picture).data, plain.data);
    for (const PassStats& pass : result.stats.passes) EXPECT_NE(pass.name, "bounce");
    bool told = false;
    for (const SkippedWork& one : result.stats.skipped) told = told || one.what == "bounces";
    EXPECT_TRUE(told);
}

// Every other method samples what the elements shine with: as near to the exact solver as its direct light is.
TEST(Bounces, OfEveryMethodComeNearTheExactSolver) {
    Scene scene = half_a_room();
    scene.lights = {PointLight{{20.3, 60.2}, {4, 3, 2}}};
    const auto errors = [&](int bounces, const ImageF& truth) {
        scene.render.bounces = bounces;
        return std::get<ErrorFigures>(error_figures(render_linear(scene), truth));
    };
    Scene unlit = scene;
    const ImageF direct = reference::solve(unlit).image;
    unlit.render.bounces = 3;
    const ImageF bounced = reference::solve(unlit).image;
    for (const char* method : {"rc", "rc_fix", "hrc", "reference"}) {
        scene.render.method = method;
        const ErrorFigures without = errors(0, direct), with = errors(3, bounced), missing = errors(0, bounced);
        std::printf("%s: rel %.2e bias %+.2e; direct light alone %.2e %+.2e\n", method, *with.rel, *with.bias, *without.rel, *without.bias);
        EXPECT_LT(*with.rel, std::max(*without.rel, 5e-3)) << method;
        EXPECT_LT(std::abs(*with.bias), std::max(1.5 * std::abs(*without.bias), 8e-3)) << method;
        EXPECT_GT(*missing.rel, 5 * *with.rel) << method << ": the bounces are a part of it that counts";
    }
}

TEST(Bounces, OfEveryMethodFillAClosedFurnace) {
    Scene scene = bouncing(furnace(0.5, 0.6), 2);
    for (const char* method : {"rc", "rc_fix", "hrc", "reference"}) {
        scene.render.method = method;
        const ImageF picture = render_linear(scene);
        const ImageF direct = render_linear(bouncing(scene, 0));
        // Every surface shines alike: whatever a method loses of the direct light (rc: two parts in a hundred), it loses of all.
        for (int y = 5; y < 35; ++y)
            for (int x = 5; x < 43; ++x)
                ASSERT_NEAR(picture.at(x, y)[1], direct.at(x, y)[1] * (1 + 0.6 + 0.36), 1e-3) << method << " at " << x << ", " << y;
        EXPECT_NEAR(picture.at(24, 20)[1], 0.98, 0.02) << method;
    }
}

// A wall thinner than a pixel is lit on one side: nothing of that may show on the other.
TEST(Bounces, DoNotComeThroughThinWalls) {
    Scene scene = canvas(64, 48);
    const auto wall = [&](Point at, Point size, Colour albedo) { scene.shapes.push_back(mirror(Rect{at, size, 0, 0}, albedo)); };
    wall({32, 2}, {64, 4}, Colour(0.8));
    wall({32, 46}, {64, 4}, Colour(0.8));
    wall({2, 24}, {4, 48}, Colour(0.8));
    wall({62, 24}, {4, 48}, Colour(0.8));
    wall({32.3, 24}, {0.6, 48}, Colour(0.9));
    scene.shapes.push_back(shape(Circle{{14, 20}, 3}, Colour(2)));
    for (const char* method : {"rc_fix", "hrc", "reference"}) {
        scene.render.method = method;
        const ImageF picture = render_linear(bouncing(scene, 4));
        double dark = 0, lit = 0;
        for (int y = 6; y < 42; ++y)
            for (int x = 6; x < 58; ++x) (x < 32 ? lit : dark) += double(picture.at(x, y)[1]);
        EXPECT_GT(lit, 100) << method;
        EXPECT_LT(dark, 1e-3 * lit) << method;
    }
}

TEST(Lamps, FallOffWithTheDistance) {
    Scene scene = canvas(64, 48);
    scene.lights = {PointLight{{20.5, 24.5}, {3, 2, 1}}};
    for (const char* method : {"auto", "exact", "rc", "hrc", "rc_fix", "reference"}) {
        scene.render.method = method;
        const ImageF picture = render_linear(scene);
        for (const int x : {20, 21, 25, 40, 63}) {
            const double r = std::max(std::abs(x - 20.0), 0.5);
            EXPECT_NEAR(picture.at(x, 24)[0], 3 / (2 * kPi * r), 1e-5) << method << " at " << x;
        }
    }
    // Distances are world units: twice as far apart, half the light.
    scene.canvas.view = ViewRect{0, 0, 128, 96};
    scene.lights = {PointLight{{41, 49}, {3, 2, 1}}};
    EXPECT_NEAR(render_linear(scene).at(40, 24)[0], 3 / (2 * kPi * 40), 1e-5);
}

TEST(Lamps, SpotsEndInASquaredSmoothStep) {
    Scene scene = canvas(64, 64);
    const SpotLight spot{{32.5, -40.5}, 90, 8, 20, Colour(5)};
    scene.lights = {spot};
    const ImageF picture = render_linear(scene);
    for (int x = 0; x < 64; x += 3) {
        const Point way(x - 32.0, 60 + 41.0);
        const double off = std::abs(std::atan2(way.x, way.y)) * 180 / kPi;
        const auto cosine = [](double degrees) { return std::cos(degrees * kPi / 180); };
        const double ramp = std::clamp((cosine(off) - cosine(20)) / (cosine(8) - cosine(20)), 0.0, 1.0);
        EXPECT_NEAR(picture.at(x, 60)[0], 5 * ramp * ramp / (2 * kPi * std::hypot(way.x, way.y)), 2e-6) << x;
    }
}

TEST(Lamps, ShadowsAreTheExactSolversToThePixel) {
    Scene scene = half_a_room();
    scene.sky.radiance = Colour(0);
    for (Shape& one : scene.shapes) one.emission = Colour(0);
    scene.lights = {PointLight{{20.3, 60.2}, {10, 8, 6}}, PointLight{{-30.7, -20.3}, Colour(50)}, SpotLight{{80, 12}, 130, 10, 25, {20, 30, 40}},
                    SpotLight{{60, 20}, 60, 40, 40, Colour(9)}, DirectionalLight{100, {0.3, 0.2, 0.1}}, PointLight{{72, 30}, Colour(99)}};
    for (const char* method : {"exact", "rc"}) {
        scene.render.method = method;
        const reference::Solution truth = reference::solve(scene);
        const ErrorFigures e = std::get<ErrorFigures>(error_figures(render_linear(scene), truth.image));
        EXPECT_LT(*e.rel, 1e-5) << method;
        EXPECT_LT(*e.max, 1e-3) << method;
    }
}

// Above the canvas, on every method, with shadows and bounces.
TEST(Lamps, InLumensAndLuxAreTheExactSolvers) {
    Scene scene = half_a_room();
    scene.sky.radiance = Colour(0);
    for (Shape& one : scene.shapes) one.emission = Colour(0);
    PointLight lamp{{20.3, 60.2}, {9000, 8000, 6000}};
    lamp.unit = LightUnit::lumens;
    lamp.height = 12;
    PointLight near = lamp;
    near.position = {70.1, 20.2};
    near.unit = LightUnit::candela;
    near.height = 0.6;
    near.intensity = {2, 3, 4};
    SpotLight spot{{80, 12}, 130, 10, 25, {20000, 30000, 40000}};
    spot.unit = LightUnit::lumens;
    spot.height = 30;
    spot.tilt_deg = 40;
    SpotLight level = spot;
    level.position = {-30.7, -20.3};
    level.direction_deg = 45;
    level.unit = LightUnit::candela;
    level.height = 6;
    level.tilt_deg = 0;
    DirectionalLight sun{100, {0.3, 0.2, 0.1}};
    sun.elevation_deg = 35;
    scene.lights = {lamp, near, spot, level, sun};
    const reference::Solution truth = reference::solve(scene);
    for (const char* method : {"exact", "rc", "rc_fix", "hrc", "reference"}) {
        scene.render.method = method;
        const ErrorFigures e = std::get<ErrorFigures>(error_figures(render_linear(scene), truth.image));
        EXPECT_LT(*e.rel, 2e-5) << method;
        EXPECT_LT(*e.max, 2e-3) << method;
    }
    scene.render.method = "exact";
    scene.render.bounces = 1;
    for (Shape& one : scene.shapes) one.albedo = Colour(0.7, 0.5, 0.3);
    // Hard edges of shadows on walls are as sharp as an element.
    const ErrorFigures e = std::get<ErrorFigures>(error_figures(render_linear(scene), reference::solve(scene).image));
    EXPECT_LT(*e.rel, 4e-3);
}

TEST(Lamps, HeightsAreWorldUnits) {
    Scene scene = canvas(64, 48);
    scene.canvas.view = ViewRect{0, 0, 8, 6};
    PointLight lamp{{4, 3}, Colour(12)};
    lamp.unit = LightUnit::candela;
    lamp.height = 2;
    scene.lights = {lamp};
    const double r = std::hypot(0.0625, 0.0625);
    EXPECT_NEAR(render_linear(scene).at(32, 24)[0], 12 * 2 / std::pow(r * r + 4, 1.5) / kPi, 1e-6);
}

TEST(Lamps, ManyLightsAddUp) {
    Scene scene = half_a_room();
    scene.sky.radiance = Colour(0);
    scene.shapes.back().emission = Colour(0);
    Numbers numbers(5);
    for (int i = 0; i < 300; ++i) scene.lights.push_back(PointLight{{numbers.between(-20, 116), numbers.between(-20, 100)}, Colour(numbers.between(0, 1))});
    const reference::Solution truth = reference::solve(scene);
    EXPECT_LT(*std::get<ErrorFigures>(error_figures(render_linear(scene), truth.image)).rel, 1e-4);
}

TEST(Lamps, WithARadiusAreDiscsThatShine) {
    Scene lamp = with(canvas(64, 48), {shape(Rect{{40, 24}, {4, 20}, 0, 0})});
    lamp.lights = {PointLight{{15, 24}, Colour(4), 3}};
    Scene disc = lamp;
    disc.lights.clear();
    disc.shapes.push_back(shape(Circle{{15, 24}, 3}, Colour(4.0 / 6)));
    EXPECT_EQ(render_linear(lamp).data, render_linear(disc).data);
    // Far from a small one there is no telling it from a point.
    Scene point = lamp;
    lamp.lights = {PointLight{{15.2, 24.3}, Colour(4), 0.05}};
    point.lights = {PointLight{{15.2, 24.3}, Colour(4)}};
    EXPECT_NEAR(render_linear(lamp).at(25, 40)[0], render_linear(point).at(25, 40)[0], 1e-5);
}

}  // namespace
}  // namespace penumbra::test
