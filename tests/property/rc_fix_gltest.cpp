// SPDX-License-Identifier: MIT
// What holds of `rc_fix`: a furnace, a moved scene, known light, and walls that keep theirs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr Quality kQualities[] = {Quality::draft, Quality::standard, Quality::high};

Scene fix(Scene scene, Quality quality) {
    scene.render.method = "rc_fix";
    scene.render.quality = quality;
    return scene;
}

Scene lamps_and_walls(double mirrored_at = 0) {
    const auto at = [&](double x, double y) { return Point(mirrored_at > 0 ? mirrored_at - x : x, y); };
    const double sign = mirrored_at > 0 ? -1 : 1;
    Scene scene = with(canvas(83, 61), {shape(Circle{at(22.3, 19.1), 5.2}, {3, 2, 1}), shape(Rect{at(44.6, 31.2), {4, 26}, 12 * sign, 0}),
                                        shape(Ellipse{at(65.1, 41.7), {7, 3}, 40 * sign}, {0, 0.5, 2}),
                                        shape(Line{at(8.2, 50.3), at(30.7, 54.9), 1.5}),
                                        shape(Polygon{{at(60, 6), at(72, 9), at(66, 17)}}, {1, 1, 0})});
    scene.sky.radiance = {0.01, 0.02, 0.03};
    return scene;
}

TEST(RcFix, AUniformSkyIsItself) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 3), std::pair(64, 64), std::pair(101, 37), std::pair(1, 90)})
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 0.37, 25.0}) {
                Scene scene = fix(canvas(width, height), quality);
                scene.sky.radiance = Colour(1.7);
                scene.canvas.margin = margin;
                for (const float value : render_linear(scene).data)
                    ASSERT_NEAR(value, 1.7, 2e-5) << width << "x" << height << " margin " << margin << " quality " << int(quality);
            }
}

TEST(RcFix, AnEmptySceneHasTheMeanOfItsGradientSky) {
    Scene scene = canvas(61, 34);
    scene.sky.gradient = {{0, Colour(0)}, {90, Colour(3)}, {360, Colour(0)}};
    for (const Quality quality : kQualities)
        for (const float value : render_linear(fix(scene, quality)).data) ASSERT_NEAR(value, 1.5, 2e-5) << int(quality);
}

TEST(RcFix, InAFurnaceEveryPixelHasItsLight) {
    Scene scene = lamps_and_walls();
    for (Shape& s : scene.shapes) s.emission = Colour(2);
    scene.sky.radiance = Colour(2);
    for (const Quality quality : kQualities)
        for (const float value : render_linear(fix(scene, quality)).data) ASSERT_NEAR(value, 2, 3e-5) << int(quality);
}

TEST(RcFix, TwiceTheLightIsTwiceTheValueExactly) {
    for (const Quality quality : kQualities) {
        Scene scene = fix(lamps_and_walls(), quality);
        const ImageF once = render_linear(scene);
        for (Shape& s : scene.shapes) s.emission *= 2;
        scene.sky.radiance *= 2;
        const ImageF twice = render_linear(scene);
        for (std::size_t i = 0; i < once.data.size(); ++i) ASSERT_EQ(twice.data[i], 2 * once.data[i]);
    }
}

// A ray that grazes an outline may by rounding fall on its other side; such rays are few, and worth little all in all.
void expect_same_but_for_grazing(const ImageF& a, const ImageF& b, Quality quality) {
    const double peak = largest(a);
    const Difference d = difference(a, b, 0.002 * peak);
    std::printf("quality %d: mean %.2e of the peak, %.3f %% of samples off by more than 0.2 %%\n", int(quality), d.mean / peak, 100 * d.share_above);
    EXPECT_LE(d.mean, 2e-4 * peak) << int(quality);
    EXPECT_LE(d.share_above, 0.01) << int(quality);
}

TEST(RcFix, AMirroredSceneGivesTheMirroredPicture) {
    for (const Quality quality : kQualities)
        expect_same_but_for_grazing(mirrored(render_linear(fix(lamps_and_walls(), quality))),
                                    render_linear(fix(lamps_and_walls(83), quality)), quality);
}

// A disc of radius R and radiance 1 seen from r away fills asin(R / r) / pi of all directions. Bounds from measurement on
// llvmpipe, rounded up.
TEST(RcFix, ADiscsLightIsKept) {
    constexpr double kRadius = 10;
    const double energy_bound[] = {0.04, 0.025, 0.008};
    const double relative_bound[] = {0.075, 0.03, 0.012};
    for (const Quality quality : kQualities)
        for (const Point centre : {Point(80, 80), Point(80.5, 79.5), Point(77.3, 82.6), Point(83.71, 76.09)}) {
            const ImageF picture = render_linear(fix(with(canvas(160, 160), {shape(Circle{centre, kRadius}, Colour(1))}), quality));
            double sum = 0;
            double exact_sum = 0;
            double relative = 0;
            int pixels = 0;
            for (int y = 0; y < 160; ++y)
                for (int x = 0; x < 160; ++x) {
                    const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
                    if (r < 20 || r > 60) continue;
                    const double exact = std::asin(kRadius / r) / std::numbers::pi;
                    sum += double(picture.at(x, y)[1]);
                    exact_sum += exact;
                    relative += std::abs(double(picture.at(x, y)[1]) / exact - 1);
                    ++pixels;
                }
            std::printf("quality %d, centre %g, %g: energy %+.2f %%, mean relative error %.2f %%\n", int(quality), centre.x, centre.y,
                        100 * (sum / exact_sum - 1), 100 * relative / pixels);
            EXPECT_LE(std::abs(sum / exact_sum - 1), energy_bound[int(quality)]) << int(quality);
            EXPECT_LE(relative / pixels, relative_bound[int(quality)]) << int(quality);
        }
}

// Each ray goes from where it is asked to where it is answered, and meets the walls between: through walls of 2 px nothing
// leaks (`rc` lets 1 % through).
TEST(RcFix, AClosedBoxKeepsItsLight) {
    for (const Quality quality : kQualities) {
        const ImageF picture = render_linear(fix(with(canvas(96, 96), {shape(Circle{{46.3, 49.2}, 5}, Colour(1)),
            shape(Polyline{{{26.4, 27.3}, {68.2, 25.1}, {70.6, 66.4}, {24.3, 69.7}}, 2, true})}), quality));
        double outside = 0;
        int pixels = 0;
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 96; ++x) {
                if (x > 19 && x < 76 && y > 20 && y < 75) continue;
                outside += double(picture.at(x, y)[0]);
                ++pixels;
            }
        std::printf("quality %d: mean %.2e outside, %.3f inside\n", int(quality), outside / pixels, double(picture.at(46, 38)[0]));
        EXPECT_GT(picture.at(46, 38)[0], 0.1);
        EXPECT_LE(outside / pixels, 1e-6) << int(quality);
    }
}

}  // namespace
}  // namespace penumbra::test
