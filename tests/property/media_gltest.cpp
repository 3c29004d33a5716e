// SPDX-License-Identifier: MIT
// Translucent shapes: closed forms by Beer and Lambert first, then the exact solver on the processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <variant>

#include "core/compare/error_figures.h"
#include "core/plan/support.h"
#include "core/reference/solver.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr const char* kMethods[] = {"rc", "rc_fix", "hrc", "reference"};

Shape filled(Geometry geometry, Colour extinction, Colour emission = Colour(0)) {
    Shape result = shape(std::move(geometry));
    result.medium = Medium{extinction, emission};
    return result;
}

ErrorFigures against_truth(const Scene& scene, const ImageF& truth) { return std::get<ErrorFigures>(error_figures(render_linear(scene), truth)); }

// In the middle of a disc every way out is a radius long.
TEST(Media, TheMiddleOfADiscInEveryMethod) {
    const Colour sigma(0.01, 0.05, 0.3), glow(0.1, 0, 1), sky(1, 2, 3);
    Scene scene = with(canvas(65, 65), {filled(Circle{{32.5, 32.5}, 24}, sigma, glow)});
    scene.sky.radiance = sky;
    for (const char* method : kMethods) {
        scene.render.method = method;
        const ImageF picture = render_linear(scene);
        for (int c = 0; c < 3; ++c) {
            const double passes = std::exp(-24 * sigma[c]);
            const double expected = sky[c] * passes + glow[c] * (1 - passes) / sigma[c];
            EXPECT_NEAR(picture.at(32, 32)[c], expected, 1.2e-2 * expected) << method << " " << c;
        }
    }
}

// Where the fog fills the whole domain and nothing else is there, what it takes and gives is all that there is: with
// emission = extinction times the sky's radiance the light stays what it is, everywhere, exactly.
TEST(Media, InBalanceWithTheSkyChangeNothing) {
    const Colour sigma(0.02, 0.1, 0.5), sky(1, 0.5, 2);
    Scene scene = with(canvas(48, 40), {filled(Rect{{24, 20}, {30, 18}, 20, 4}, sigma, sigma * sky), filled(Polygon{{{4, 6}, {40, 3}, {30, 36}}}, sigma, sigma * sky),
                                        filled(Ellipse{{20, 26}, {14, 6}, -20}, 2.0 * sigma, 2.0 * sigma * sky), filled(Polyline{{{5, 35}, {25, 5}, {44, 35}}, 4, false}, sigma, sigma * sky)});
    scene.sky.radiance = sky;
    for (const char* method : kMethods) {
        scene.render.method = method;
        const ImageF picture = render_linear(scene);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 48; ++x)
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(picture.at(x, y)[c], sky[c], 2e-3 * sky[c]) << method << " at " << x << ", " << y;
    }
}

Scene glass_house() {
    Scene scene = canvas(96, 80);
    scene.canvas.margin = 6;
    scene.output.antialias = false;
    scene.sky.radiance = Colour(0.05, 0.08, 0.12);
    scene.shapes = {filled(Rect{{48, 60}, {120, 50}, 0, 0}, Colour(0.012), {0.002, 0.003, 0.004}),
                    filled(Rect{{30, 30}, {6, 40}, 12, 0}, {0.02, 0.15, 0.3}),
                    filled(Circle{{66, 44}, 9}, {0.2, 0.02, 0.02}),
                    filled(Polygon{{{50, 70}, {70, 62}, {80, 76}}}, {0.02, 0.1, 0.02}),
                    shape(Circle{{14, 26}, 5}, {4, 3, 2}),
                    shape(Circle{{82, 20}, 4}, {1, 2, 5}),
                    shape(Rect{{48, 24}, {3, 18}, 20, 0}),
                    shape(Ellipse{{62, 70}, {8, 3}, 10})};
    return scene;
}

TEST(Media, ComeNearTheExactSolver) {
    Scene scene = glass_house();
    Scene opaque = scene;
    std::erase_if(opaque.shapes, [](const Shape& one) { return one.medium.has_value(); });
    const ImageF truth = reference::solve(scene).image, clear = reference::solve(opaque).image;
    for (const char* method : kMethods) {
        scene.render.method = opaque.render.method = method;
        const ErrorFigures with = against_truth(scene, truth), without = against_truth(opaque, clear), missing = against_truth(opaque, truth);
        std::printf("%s: rel %.2e bias %+.2e; without media %.2e %+.2e\n", method, *with.rel, *with.bias, *without.rel, *without.bias);
        EXPECT_LT(*with.rel, 1.5 * *without.rel + 5e-3) << method;
        EXPECT_LT(std::abs(*with.bias), std::abs(*without.bias) + 1e-2) << method;
        EXPECT_GT(*missing.rel, 4 * *with.rel) << method << ": media are a part of it that counts";
    }
}

TEST(Media, WeakenLightsWithoutASize) {
    Scene scene = glass_house();
    scene.sky.radiance = Colour(0);
    for (Shape& one : scene.shapes) {
        one.emission = Colour(0);
        if (one.medium) one.medium->emission = Colour(0);
    }
    scene.lights = {PointLight{{20.3, 60.2}, {10, 8, 6}}, SpotLight{{80, -30}, 100, 20, 35, {20, 30, 40}}, DirectionalLight{70, {0.3, 0.2, 0.1}}};
    const ImageF truth = reference::solve(scene).image;
    for (const char* method : {"rc", "hrc"}) {
        scene.render.method = method;
        const ErrorFigures e = against_truth(scene, truth);
        EXPECT_LT(*e.rel, 2e-4) << method;
    }
}

TEST(Media, ThatDoNothingChangeNoByte) {
    Scene plain = glass_house();
    std::erase_if(plain.shapes, [](const Shape& one) { return one.medium.has_value(); });
    Scene clear = plain;
    clear.shapes.insert(clear.shapes.begin(), filled(Circle{{50, 40}, 20}, Colour(0)));
    for (const char* method : {"auto", "hrc"}) {
        plain.render.method = clear.render.method = method;
        EXPECT_EQ(render_linear(plain).data, render_linear(clear).data) << method;
    }
}

// Thick enough, and as bright as it is thick, a medium looks like a lamp from outside.
TEST(Media, InTheOpaqueLimitAreLamps) {
    Scene lamp = with(canvas(64, 48), {shape(Circle{{20, 24}, 6}, {3, 2, 1}), shape(Rect{{42, 24}, {4, 16}, 15, 0})});
    Scene thick = with(canvas(64, 48), {filled(Circle{{20, 24}, 6}, Colour(1e4), {3e4, 2e4, 1e4}), filled(Rect{{42, 24}, {4, 16}, 15, 0}, Colour(1e4))});
    for (const char* method : kMethods) {
        lamp.render.method = thick.render.method = method;
        const ImageF a = render_linear(lamp), b = render_linear(thick);
        double off = 0, all = 0;
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const bool inside = std::hypot(x + 0.5 - 20, y + 0.5 - 24) < 7.5 || std::abs(x + 0.5 - 42) < 7;
                if (inside) continue;
                off += std::abs(double(a.at(x, y)[0]) - double(b.at(x, y)[0]));
                all += double(a.at(x, y)[0]);
            }
        EXPECT_LT(off, 0.06 * all) << method;
    }
}

TEST(Media, AutoTakesAMethodThatHasThem) {
    const RenderResult result = shared_renderer().render(glass_house());
    EXPECT_EQ(result.stats.method, "hrc");
    EXPECT_EQ(result.stats.lost_rays, 0u);
    Scene scene = glass_house();
    scene.render.method = "exact";
    ASSERT_EQ(unsupported(scene).size(), 1u);
    EXPECT_EQ(unsupported(scene)[0].pointer, "/render/method");
    scene.render.method = "auto";
    scene.render.bounces = 1;
    ASSERT_EQ(unsupported(scene).size(), 1u);
    EXPECT_EQ(unsupported(scene)[0].pointer, "/render/bounces");
    EXPECT_NE(unsupported(scene)[0].message.find("/shapes/0/medium"), std::string::npos);
}

TEST(Media, ARegionIsTheCrop) {
    Scene scene = glass_house();
    scene.render.method = "hrc";
    const ImageF whole = render_linear(scene);
    scene.canvas.region = PixelRect{20, 16, 40, 30};
    const ImageF part = render_linear(scene);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) ASSERT_EQ(part.at(x, y)[0], whole.at(x + 20, y + 16)[0]);
}

}  // namespace
}  // namespace penumbra::test
