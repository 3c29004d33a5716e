// SPDX-License-Identifier: MIT
// Floors with pictures, relief and gloss, and strokes whose emission changes: the device against the exact solver.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/compare/error_figures.h"
#include "core/plan/support.h"
#include "core/reference/solver.h"
#include "core/scene/validate.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

std::shared_ptr<const Texels> one_texel(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    auto made = std::make_shared<Texels>();
    made->width = made->height = 1;
    made->rgba = {r, g, b, 255};
    return made;
}

// Bumps and dents.
std::shared_ptr<const Texels> waves(int size) {
    auto made = std::make_shared<Texels>();
    made->width = made->height = size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double a = std::sin(6.2831853 * x / size), b = std::cos(6.2831853 * y / size);
            const double z = std::sqrt(std::max(1 - 0.45 * (a * a + b * b), 0.05));
            for (const double v : {0.6 * a, 0.6 * b, z}) made->rgba.push_back(std::uint8_t(std::clamp(128 + 127 * v, 0.0, 255.0)));
            made->rgba.push_back(255);
        }
    return made;
}

std::shared_ptr<const Texels> tiles(int size) {
    auto made = std::make_shared<Texels>();
    made->width = made->height = size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (const int v : {120 + 9 * x % 130, 200 - 7 * y % 150, (x / 4 + y / 4) % 2 ? 220 : 90, 255}) made->rgba.push_back(std::uint8_t(v));
    return made;
}

Scene yard() {
    Scene scene = with(canvas(96, 80), {shape(Circle{{30, 25}, 6}, Colour(4, 3, 2)), shape(Rect{{60, 40}, {24, 5}, 30, 0}),
                                        shape(Ellipse{{75, 65}, {9, 4}, 20}, Colour(0.5, 1, 2)), shape(Line{{10, 60}, {30, 70}, 2})});
    scene.canvas.floor_albedo = Colour(0.9, 0.8, 0.7);
    return scene;
}

void add_lights(Scene& scene) {
    scene.lights.push_back(PointLight{{82, 14}, Colour(9, 8, 7)});
    PointLight lamp{{15, 40}, Colour(2000, 1500, 1000)};
    lamp.unit = LightUnit::lumens;
    lamp.height = 9;
    scene.lights.push_back(lamp);
    SpotLight spot{{50, 75}, 290, 20, 40, Colour(800)};
    spot.unit = LightUnit::candela;
    spot.height = 12;
    spot.tilt_deg = 25;
    scene.lights.push_back(spot);
    DirectionalLight sun{200, {0.4, 0.5, 0.6}};
    sun.elevation_deg = 25;
    scene.lights.push_back(sun);
    scene.lights.push_back(DirectionalLight{40, Colour(0.3)});
}

ErrorFigures errors(const Scene& scene) {
    return std::get<ErrorFigures>(error_figures(render_linear(scene), reference::solve(scene).image));
}

TEST(Floors, PicturesMultiplyAnyMethodsLight) {
    Scene scene = yard();
    add_lights(scene);
    for (const char* method : {"exact", "rc", "rc_fix", "hrc", "reference"}) {
        scene.render.method = method;
        scene.canvas.floor.image = nullptr;
        scene.canvas.region.reset();
        const ImageF plain = render_linear(scene);
        scene.canvas.floor.image = tiles(24);
        const ImageF painted = render_linear(scene);
        scene.canvas.region = PixelRect{17, 9, 40, 30};
        const ImageF part = render_linear(scene);
        scene.canvas.region.reset();
        Scene bare = scene;
        bare.shapes.clear();
        bare.lights.clear();
        bare.sky.radiance = Colour(1);
        const ImageF picture = render_linear(bare);
        for (int y = 0; y < 80; y += 3)
            for (int x = 0; x < 96; x += 3) {
                const bool solid = reference::ExactSolver(scene).is_solid({x + 0.5, y + 0.5});
                for (int c = 0; c < 3; ++c) {
                    const double right = solid ? plain.at(x, y)[c] : plain.at(x, y)[c] / scene.canvas.floor_albedo[c] * picture.at(x, y)[c];
                    ASSERT_NEAR(painted.at(x, y)[c], right, 2e-6 + 2e-5 * right) << method << " " << x << " " << y;
                }
            }
        const double tolerance = std::string(method) == "rc" || std::string(method) == "rc_fix" ? 2e-3 : 1e-6;
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                ASSERT_NEAR(part.at(x, y)[0], painted.at(x + 17, y + 9)[0], tolerance * (1 + painted.at(x + 17, y + 9)[0])) << method << " " << x << " " << y;
    }
}

TEST(Floors, AFlatNormalMapIsThePlainPicture) {
    Scene scene = yard();
    const ImageF plain = render_linear(scene);
    scene.canvas.floor.normals = one_texel(128, 128, 255);
    EXPECT_EQ(render_linear(scene).data, plain.data);
    add_lights(scene);
    const ImageF lit = render_linear(scene);
    scene.canvas.floor.normals = nullptr;
    const ErrorFigures e = std::get<ErrorFigures>(error_figures(lit, render_linear(scene)));
    EXPECT_LT(*e.max, 1e-5);
}

TEST(Floors, ReliefIsTheExactSolvers) {
    for (const bool sky : {false, true}) {
        Scene scene = yard();
        scene.canvas.floor.normals = waves(16);
        scene.canvas.floor.tile = ViewRect{3, 5, 24, 24};
        if (sky) scene.sky.gradient = {{10, Colour(0.2, 0.1, 0.1)}, {150, Colour(0.8)}, {150, Colour(0.1)}, {300, Colour(0.4, 0.5, 0.6)}};
        const ErrorFigures e = errors(scene);
        EXPECT_LT(*e.rel, 2e-3) << sky;
        EXPECT_LT(*e.p99, 1.5e-2) << sky;
        scene.render.quality = Quality::high;
        EXPECT_LT(*errors(scene).rel, 5e-4) << sky;
        add_lights(scene);
        EXPECT_LT(*errors(scene).rel, 5e-4) << sky;
    }
}

TEST(Floors, GlossIsTheExactSolvers) {
    for (const double roughness : {0.15, 0.5, 1.0}) {
        Scene scene = yard();
        scene.sky.radiance = Colour(0.1, 0.2, 0.3);
        scene.canvas.floor.normals = waves(16);
        scene.canvas.floor.tile = ViewRect{0, 0, 32, 32};
        scene.canvas.floor.image = tiles(24);
        scene.canvas.floor.gloss = Gloss{roughness, 0.4, 0.6};
        add_lights(scene);
        EXPECT_LT(*errors(scene).rel, 2e-3) << roughness;
    }
    // Without pictures: one response for all.
    Scene scene = yard();
    scene.canvas.floor.gloss = Gloss{0.3, 0, 0.5};
    add_lights(scene);
    EXPECT_LT(*errors(scene).rel, 2e-3);
}

TEST(Floors, WithBouncesAndAsARegion) {
    Scene scene = yard();
    for (Shape& one : scene.shapes) one.albedo = Colour(0.6);
    scene.render.bounces = 2;
    scene.canvas.floor.normals = waves(16);
    add_lights(scene);
    EXPECT_LT(*errors(scene).rel, 3e-3);
    const ImageF whole = render_linear(scene);
    scene.canvas.region = PixelRect{20, 30, 33, 25};
    const ImageF part = render_linear(scene);
    for (int y = 0; y < 25; ++y)
        for (int x = 0; x < 33; ++x) ASSERT_NEAR(part.at(x, y)[1], whole.at(x + 20, y + 30)[1], 1e-6) << x << " " << y;
}

TEST(Floors, OnlyLightsWithoutASize) {
    Scene scene = yard();
    for (Shape& one : scene.shapes) one.emission = Colour(0);
    scene.canvas.floor.normals = waves(16);
    add_lights(scene);
    EXPECT_LT(*errors(scene).rel, 1e-4);
    scene.shapes.clear();
    EXPECT_LT(*errors(scene).rel, 1e-4);
    scene.lights.clear();
    scene.sky.radiance = Colour(1);
    EXPECT_LT(*errors(scene).rel, 1e-5);
}

TEST(Floors, OtherMethodsRefuseReliefByName) {
    Scene scene = yard();
    scene.canvas.floor.normals = one_texel(128, 128, 255);
    for (const char* method : {"rc", "rc_fix", "hrc", "reference"}) {
        scene.render.method = method;
        const Problems problems = unsupported(scene, {});
        ASSERT_EQ(problems.size(), 1u) << method;
        EXPECT_EQ(problems[0].pointer, "/canvas/floor");
        EXPECT_NE(problems[0].message.find(method), std::string::npos);
    }
    scene.render.method = "auto";
    EXPECT_TRUE(unsupported(scene, {}).empty());
    EXPECT_EQ(shared_renderer().render(scene).stats.method, "exact");
}

// ---- gradients along strokes

Shape stroke(Geometry geometry) {
    Shape made = shape(std::move(geometry));
    made.gradient = {{0, Colour(4, 1, 0)}, {0.4, Colour(0, 3, 1)}, {0.4, Colour(1, 0, 5)}, {1, Colour(0.2)}};
    return made;
}

Scene strokes() {
    Polyline bent;
    bent.points = {{20.3, 60.2}, {40, 70}, {45, 50}, {70, 55.5}};
    bent.width = 4;
    Scene scene = with(canvas(96, 80), {stroke(Line{{10, 20}, {70, 12}, 3}), stroke(bent), shape(Rect{{45, 32}, {20, 4}, 10, 0})});
    return scene;
}

TEST(Gradients, AreTheExactSolversOnEveryMethod) {
    Scene scene = strokes();
    const reference::Solution truth = reference::solve(scene);
    const std::pair<const char*, double> bounds[] = {{"exact", 3e-3}, {"hrc", 0.03}, {"rc", 0.06}, {"rc_fix", 0.07}, {"reference", 0.03}};
    for (const auto& [method, most] : bounds) {
        scene.render.method = method;
        const ErrorFigures e = std::get<ErrorFigures>(error_figures(render_linear(scene), truth.image));
        EXPECT_LT(*e.rel, most) << method;
        EXPECT_LT(std::abs(*e.bias), std::string(method).starts_with("rc") ? 0.03 : 5e-3) << method;
    }
    // More rays come nearer: nothing but sampling is between.
    scene.render.quality = Quality::high;
    EXPECT_LT(*std::get<ErrorFigures>(error_figures(render_linear(scene), truth.image)).rel, 0.01);
    scene.render.method = "exact";
    scene.render.quality = Quality::high;
    EXPECT_LT(*errors(scene).rel, 1e-3);
}

TEST(Gradients, WithBouncesAndRelief) {
    Scene scene = strokes();
    for (Shape& one : scene.shapes) one.albedo = Colour(0.5, 0.7, 0.9);
    scene.render.bounces = 2;
    EXPECT_LT(*errors(scene).rel, 3e-3);
    scene.render.bounces = 0;
    scene.canvas.floor.normals = waves(16);
    EXPECT_LT(*errors(scene).rel, 4e-3);
}

TEST(Gradients, AStrokeShowsItsColours) {
    Scene scene = canvas(64, 16);
    Shape line = shape(Line{{8, 8}, {56, 8}, 8});
    line.gradient = {{0, Colour(0)}, {1, Colour(1)}};
    scene.shapes = {line};
    Polyline same;
    same.points = {{8, 8}, {20, 8}, {56, 8}};
    same.width = 8;
    for (const char* method : {"exact", "rc"}) {
        scene.render.method = method;
        scene.shapes[0].geometry = Line{{8, 8}, {56, 8}, 8};
        for (int k = 0; k < 2; ++k) {
            const ImageF picture = render_linear(scene);
            for (const int x : {6, 8, 20, 40, 55, 58}) EXPECT_NEAR(picture.at(x, 8)[0], std::clamp((x + 0.5 - 8) / 48, 0.0, 1.0), 1e-5) << x;
            scene.shapes[0].geometry = same;
        }
    }
}

}  // namespace
}  // namespace penumbra::test
