// SPDX-License-Identifier: MIT
// What light does: nothing from nothing, a sky is what it is, more gives more, channels keep apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr Quality kQualities[] = {Quality::draft, Quality::standard, Quality::high};

// One of each: what is lit takes its colours from `lamps`, the rest is black.
Scene of_everything(int width, int height, const std::vector<Colour>& lamps) {
    const auto lamp = [&](std::size_t i) { return i < lamps.size() ? lamps[i] : Colour(0); };
    const double w = width;
    const double h = height;
    return with(rc_canvas(width, height),
                {shape(Circle{{0.21 * w, 0.33 * h}, 0.07 * h}, lamp(0)), shape(Ellipse{{0.71 * w, 0.71 * h}, {0.11 * h, 0.06 * h}, 30}, lamp(1)),
                 shape(Rect{{0.52 * w, 0.44 * h}, {0.03 * w, 0.4 * h}, 12, 0}), shape(Line{{0.3 * w, 0.8 * h}, {0.45 * w, 0.9 * h}, 2.1}, lamp(2)),
                 shape(Polyline{{{0.8 * w, 0.1 * h}, {0.9 * w, 0.2 * h}, {0.78 * w, 0.3 * h}}, 1.7, false}),
                 shape(Polygon{{{0.1 * w, 0.7 * h}, {0.2 * w, 0.75 * h}, {0.12 * w, 0.92 * h}}}, lamp(3))});
}

TEST(Nothing, AnEmptySceneIsBlack) {
    for (const Quality quality : kQualities) {
        Scene scene = rc_canvas(33, 21);
        scene.render.quality = quality;
        EXPECT_EQ(largest(render_linear(scene)), 0);
        for (const std::uint8_t code : render_display(scene).data) EXPECT_EQ(code, 0);
    }
}

TEST(Nothing, WhereNothingEmitsAllIsExactlyBlack) {
    for (const Quality quality : kQualities) {
        Scene scene = of_everything(64, 48, {});
        scene.render.quality = quality;
        scene.canvas.margin = 7;
        EXPECT_EQ(largest(render_linear(scene)), 0);
        for (const std::uint8_t code : render_display(scene).data) EXPECT_EQ(code, 0);
    }
}

TEST(Nothing, WhatIsUnlitStaysBlackBesideALamp) {
    // Errata E-9: the seed added light to the picture, so that solids shone.
    const Scene scene = of_everything(64, 48, {Colour(5)});
    const ImageF picture = render_linear(scene);
    EXPECT_EQ(picture.at(33, 21)[0], 0) << "inside the black rect";
    EXPECT_EQ(picture.at(45, 34)[0], 0) << "inside the black ellipse";
}

TEST(UniformSky, IsExactlyItselfAtAnySizeQualityAndMargin) {
    // Errata E-8: the seed's divisor made it 1, 2 and 4 times as bright.
    const Colour sky(0.3, 1.7, 1234.5);
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 3), std::pair(7, 5), std::pair(64, 64), std::pair(101, 37), std::pair(1, 90)})
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 0.37, 25.0}) {
                Scene scene = rc_canvas(width, height);
                scene.sky.radiance = sky;
                scene.render.quality = quality;
                scene.canvas.margin = margin;
                const ImageF picture = render_linear(scene);
                for (std::size_t i = 0; i < picture.data.size(); ++i) {
                    const double wanted = sky[static_cast<int>(i % 3)];
                    ASSERT_NEAR(picture.data[i], wanted, 1e-5 * wanted) << width << "x" << height << " margin " << margin;
                }
            }
}

TEST(UniformSky, InAFurnaceEveryPixelHasIt) {
    // Lamps and sky of one radiance: whatever a ray meets, it brings that.
    for (const Quality quality : kQualities) {
        Scene scene = of_everything(64, 48, {Colour(2), Colour(2), Colour(2), Colour(2)});
        scene.shapes[2].emission = scene.shapes[4].emission = Colour(2);
        scene.sky.radiance = Colour(2);
        scene.render.quality = quality;
        for (const float value : render_linear(scene).data) ASSERT_NEAR(value, 2, 2e-5) << int(quality);
    }
}

TEST(GradientSky, AnEmptySceneHasItsMean) {
    Scene scene = rc_canvas(61, 34);
    scene.sky.gradient = {{20, {1, 0, 0}}, {100, {0, 2, 0}}, {100, {5, 5, 5}}, {230, {0, 0, 1}}};
    // Trapezoids between 20, 100, 230 and 380 degrees.
    const Colour mean = (80.0 * Colour(0.5, 1, 0) + 130.0 * Colour(2.5, 2.5, 3) + 150.0 * Colour(0.5, 0, 0.5)) / 360.0;
    for (const Quality quality : kQualities) {
        scene.render.quality = quality;
        const ImageF picture = render_linear(scene);
        for (std::size_t i = 0; i < picture.data.size(); ++i) ASSERT_NEAR(picture.data[i], mean[static_cast<int>(i % 3)], 2e-5);
    }
}

TEST(GradientSky, AWallHidesTheSideBehindIt) {
    // A wall left of everything (the sky there is at 180 degrees) leaves only the sky of the right half.
    Scene scene = with(rc_canvas(40, 40), {shape(Rect{{1, 20}, {1.5, 500}, 0, 0})});
    scene.sky.gradient = {{90, {0, 1, 0}}, {90, {1, 0, 0}}, {270, {1, 0, 0}}, {270, {0, 1, 0}}};  // red on the left
    const ImageF picture = render_linear(scene);
    // 1.75 px from the wall and 20 from the canvas' ends, a little of the left is seen past the wall's ends.
    const double beside = 2 * std::atan(1.75 / 20) / (2 * std::numbers::pi);
    EXPECT_NEAR(picture.at(3, 20)[0], beside, 0.02);
    EXPECT_NEAR(picture.at(3, 20)[1], 0.5, 0.02);
}

TEST(Emission, DoubledDoublesEveryValueExactly) {
    // A power of two moves exponents and nothing else.
    for (const Quality quality : kQualities) {
        Scene scene = of_everything(64, 48, {{1, 2, 3}, {0.1, 0, 0.3}, {7, 5, 1}});
        scene.sky.radiance = {0.03, 0.01, 0.02};
        scene.render.quality = quality;
        const ImageF once = render_linear(scene);
        for (Shape& s : scene.shapes) s.emission *= 2;
        scene.sky.radiance *= 2;
        const ImageF twice = render_linear(scene);
        for (std::size_t i = 0; i < once.data.size(); ++i) ASSERT_EQ(twice.data[i], 2 * once.data[i]);
    }
}

TEST(Emission, ApartSumsToTogether) {
    const Colour zero(0);
    const Colour a(1, 2, 3);
    const Colour b(0.5, 0, 4);
    ImageF first = render_linear(of_everything(64, 48, {a, zero, b, zero}));
    const ImageF second = render_linear(of_everything(64, 48, {zero, b, zero, a}));
    const ImageF both = render_linear(of_everything(64, 48, {a, b, b, a}));
    for (std::size_t i = 0; i < first.data.size(); ++i) first.data[i] += second.data[i];
    // The rays are the same; only sums are rounded in another order, a few hundred terms at 6e-8 each.
    EXPECT_LE(difference(first, both).max, 1e-5 * largest(both));
}

TEST(Channels, KeepApart) {
    const std::vector<Colour> lamps = {{1, 2, 3}, {0.1, 0, 0.3}, {7, 5, 1}};
    Scene scene = of_everything(64, 48, lamps);
    scene.sky.radiance = {0.03, 0.01, 0.02};
    const ImageF picture = render_linear(scene);
    const auto swap = [](Colour c) { return Colour(c.b, c.r, c.g); };
    for (Shape& s : scene.shapes) s.emission = swap(s.emission);
    scene.sky.radiance = swap(scene.sky.radiance);
    const ImageF swapped = render_linear(scene);
    for (std::size_t i = 0; i < picture.data.size(); i += 3) {
        ASSERT_EQ(swapped.data[i], picture.data[i + 2]);
        ASSERT_EQ(swapped.data[i + 1], picture.data[i]);
        ASSERT_EQ(swapped.data[i + 2], picture.data[i + 1]);
    }
}

TEST(Occluders, NeverBrightenTheMean) {
    Numbers numbers(11);
    Scene scene = with(rc_canvas(72, 56), {shape(Circle{{20.3, 21.4}, 5}, {1, 2, 3})});
    scene.sky.radiance = Colour(0.1);
    double before = mean(render_linear(scene));
    for (int i = 0; i < 10; ++i) {
        const Point at{numbers.between(0, 72), numbers.between(0, 56)};
        if (i % 2 == 0) scene.shapes.insert(scene.shapes.begin(), shape(Circle{at, numbers.between(0.5, 5)}));
        else scene.shapes.insert(scene.shapes.begin(), shape(Rect{at, {numbers.between(1, 20), 1.3}, numbers.between(0, 180), 0}));
        const double after = mean(render_linear(scene));
        EXPECT_LE(after, before) << "occluder " << i;
        before = after;
    }
}

// Cascades interpolate between probes on both sides of a wall: some light leaks, less through thicker walls and
// between finer probes. Bounds from measurement on llvmpipe, rounded up; the light inside is about 0.16.
struct Leak {
    double wall;
    Quality quality;
    double mean, most;
};

TEST(ClosedBox, KeepsItsLight) {
    for (const Leak& leak : {Leak{1, Quality::draft, 6e-3, 0.05}, Leak{1, Quality::standard, 3e-3, 0.045}, Leak{1, Quality::high, 1e-3, 0.025},
                             Leak{2, Quality::draft, 4e-3, 0.025}, Leak{2, Quality::standard, 1.5e-3, 0.02}, Leak{2, Quality::high, 3e-4, 6e-3},
                             Leak{4, Quality::draft, 1.2e-3, 0.01}, Leak{4, Quality::standard, 3e-4, 5e-3}, Leak{4, Quality::high, 1e-6, 1e-5}}) {
        Scene scene = with(rc_canvas(96, 96), {shape(Circle{{46.3, 49.2}, 5}, Colour(1)),
                                            shape(Polyline{{{26.4, 27.3}, {68.2, 25.1}, {70.6, 66.4}, {24.3, 69.7}}, leak.wall, true})});
        scene.render.quality = leak.quality;
        const ImageF picture = render_linear(scene);
        double outside = 0;
        double brightest = 0;
        int pixels = 0;
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 96; ++x) {
                if (x > 19 && x < 76 && y > 20 && y < 75) continue;  // the box and its walls
                outside += double(picture.at(x, y)[0]);
                brightest = std::max(brightest, double(picture.at(x, y)[0]));
                ++pixels;
            }
        const double inside = double(picture.at(46, 38)[0]);
        std::printf("box of walls %g px, quality %d: mean %.2e, at most %.2e outside, %.3f inside\n", leak.wall, int(leak.quality),
                    outside / pixels, brightest, inside);
        EXPECT_GT(inside, 0.1);
        EXPECT_LE(outside / pixels, leak.mean) << leak.wall << " " << int(leak.quality);
        EXPECT_LE(brightest, leak.most) << leak.wall << " " << int(leak.quality);
    }
}

}  // namespace
}  // namespace penumbra::test
