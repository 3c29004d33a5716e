// SPDX-License-Identifier: MIT
// What must hold of light holds of the method hrc, at any size of canvas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr Quality kQualities[] = {Quality::draft, Quality::standard, Quality::high};
constexpr std::pair<int, int> kSizes[] = {{1, 1}, {2, 3}, {7, 5}, {64, 64}, {101, 37}, {1, 90}, {113, 1}, {33, 64}};

Scene hrc_canvas(int width, int height, Quality quality) {
    Scene scene = canvas(width, height);
    scene.render.method = "hrc";
    scene.render.quality = quality;
    return scene;
}

std::vector<Shape> lamps_and_walls(Point centre, double unit, const std::function<Point(Point)>& map, double turned_deg, bool mirrors) {
    const auto at = [&](double x, double y) { return map(centre + unit * Point(x, y)); };
    const auto angle = [&](double degrees) { return (mirrors ? -degrees : degrees) + turned_deg; };
    return {shape(Circle{at(-0.42, -0.31), 0.11 * unit}, {3, 2, 1}),
            shape(Rect{at(0.13, 0.05), {0.11 * unit, 0.7 * unit}, angle(12), 0.02 * unit}),
            shape(Ellipse{at(0.52, 0.33), {0.17 * unit, 0.08 * unit}, angle(40)}, {0, 0.5, 2}),
            shape(Line{at(-0.3, 0.42), at(-0.1, 0.57), 0.05 * unit}, {0.3, 0.3, 0}),
            shape(Polygon{{at(-0.7, 0.2), at(-0.55, 0.28), at(-0.66, 0.5)}}),
            shape(Polyline{{at(0.4, -0.6), at(0.65, -0.45), at(0.45, -0.25)}, 0.06 * unit, false})};
}

TEST(HrcSky, UniformIsExactlyItselfAtAnySizeQualityAndMargin) {
    const Colour sky(0.3, 1.7, 1234.5);
    for (const auto& [width, height] : kSizes)
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 0.37, 25.0}) {
                Scene scene = hrc_canvas(width, height, quality);
                scene.sky.radiance = sky;
                scene.canvas.margin = margin;
                const ImageF picture = render_linear(scene);
                for (std::size_t i = 0; i < picture.data.size(); ++i) {
                    const double wanted = sky[static_cast<int>(i % 3)];
                    ASSERT_NEAR(picture.data[i], wanted, 1e-5 * wanted) << width << "x" << height << " margin " << margin << " " << int(quality);
                }
            }
}

TEST(HrcSky, AnEmptySceneHasTheMeanOfAGradient) {
    // Trapezoids between 20, 100, 230 and 380 degrees.
    const Colour mean = (80.0 * Colour(0.5, 1, 0) + 130.0 * Colour(2.5, 2.5, 3) + 150.0 * Colour(0.5, 0, 0.5)) / 360.0;
    for (const auto& [width, height] : kSizes)
        for (const Quality quality : kQualities) {
            Scene scene = hrc_canvas(width, height, quality);
            scene.sky.gradient = {{20, {1, 0, 0}}, {100, {0, 2, 0}}, {100, {5, 5, 5}}, {230, {0, 0, 1}}};
            const ImageF picture = render_linear(scene);
            for (std::size_t i = 0; i < picture.data.size(); ++i)
                ASSERT_NEAR(picture.data[i], mean[static_cast<int>(i % 3)], 2e-5) << width << "x" << height;
        }
}

TEST(HrcSky, AWallHidesTheSideBehindIt) {
    for (const Quality quality : kQualities) {
        Scene scene = with(hrc_canvas(40, 40, quality), {shape(Rect{{1, 20}, {1.5, 500}, 0, 0})});
        scene.sky.gradient = {{90, {0, 1, 0}}, {90, {1, 0, 0}}, {270, {1, 0, 0}}, {270, {0, 1, 0}}};  // red on the left
        const ImageF picture = render_linear(scene);
        const double beside = 2 * std::atan(1.75 / 20) / (2 * std::numbers::pi);
        EXPECT_NEAR(picture.at(3, 20)[0], beside, 0.02);
        EXPECT_NEAR(picture.at(3, 20)[1], 0.5, 0.02);
    }
}

TEST(HrcFurnace, EveryFreePixelHasTheOneRadiance) {
    for (const auto& [width, height] : {std::pair(64, 48), std::pair(61, 47), std::pair(37, 90)})
        for (const Quality quality : kQualities) {
            Scene scene = hrc_canvas(width, height, quality);
            scene.shapes = lamps_and_walls({0.5 * width, 0.5 * height}, 0.5 * std::min(width, height), [](Point p) { return p; }, 0, false);
            for (Shape& s : scene.shapes) s.emission = Colour(2);
            scene.sky.radiance = Colour(2);
            scene.canvas.margin = 3.3;
            for (const float value : render_linear(scene).data) ASSERT_NEAR(value, 2, 4e-5) << width << " " << int(quality);
        }
}

TEST(HrcFurnace, HoldsWithABitmap) {
    const auto image = picture(12, 9, [](int x, int y) { return (x / 3 + y / 3) % 2 == 0; });
    for (const Quality quality : kQualities) {
        Scene scene = hrc_canvas(53, 40, quality);
        scene.shapes.push_back(shape(Bitmap{image, {14.3, 9.6}, {24, 18}, 2.0, 0.5, false}));
        scene.sky.radiance = Colour(2);
        for (const float value : render_linear(scene).data) ASSERT_NEAR(value, 2, 4e-5) << int(quality);
    }
}

TEST(HrcBitmap, ShinesLikeTheRectOfItsSize) {
    const auto image = picture(8, 8, [](int, int) { return true; });
    for (const Quality quality : kQualities) {
        Scene bitmap = hrc_canvas(64, 64, quality);
        Scene rect = bitmap;
        bitmap.shapes.push_back(shape(Bitmap{image, {24, 20}, {16, 12}, 1.0, 0.5, false}));
        rect.shapes.push_back(shape(Rect{{32, 26}, {16, 12}, 0, 0}, Colour(1)));
        const double a = mean(render_linear(bitmap));
        const double b = mean(render_linear(rect));
        EXPECT_NEAR(a / b, 1, 0.02) << int(quality);
    }
}

// Rays at mirrored angles are computed by other roundings, and one that grazes an outline may fall on its other side.
void expect_same_but_for_grazing(const ImageF& a, const ImageF& b, const char* what) {
    const double peak = largest(a);
    const Difference d = difference(a, b, 0.002 * peak);
    std::printf("%s: mean %.2e of the peak, %.3f %% of samples off by more than 0.2 %%, at most %.4f\n", what, d.mean / peak,
                100 * d.share_above, d.max / peak);
    EXPECT_LE(d.mean, 2e-4 * peak) << what;
    EXPECT_LE(d.share_above, 0.01) << what;
}

TEST(HrcSymmetry, MirroredFlippedAndTurnedScenesGiveSuchPictures) {
    for (const auto& [w, h] : {std::pair(64, 64), std::pair(61, 47), std::pair(37, 90)})
        for (const Quality quality : kQualities) {
            const int width = w;
            const int height = h;
            const auto rendered = [&](int wide, int high, const std::function<Point(Point)>& map, double turned_deg, bool mirrors) {
                Scene scene = hrc_canvas(wide, high, quality);
                scene.sky.radiance = {0.01, 0.02, 0.03};
                scene.shapes = lamps_and_walls({0.5 * width + 0.27, 0.5 * height - 0.19}, 0.5 * std::min(width, height), map, turned_deg, mirrors);
                return render_linear(scene);
            };
            const ImageF plain = rendered(width, height, [](Point p) { return p; }, 0, false);
            const ImageF mirror = rendered(width, height, [&](Point p) { return Point(width - p.x, p.y); }, 0, true);
            const ImageF flip = rendered(width, height, [&](Point p) { return Point(p.x, height - p.y); }, 0, true);
            const ImageF turn = rendered(height, width, [&](Point p) { return Point(height - p.y, p.x); }, 90, false);
            expect_same_but_for_grazing(mirrored(plain), mirror, "mirrored");
            expect_same_but_for_grazing(flipped(plain), flip, "flipped");
            expect_same_but_for_grazing(turned(plain), turn, "turned");
            EXPECT_GT(difference(plain, mirror).mean, 1e-2) << "the scene must not be its own mirror image";
        }
}

TEST(HrcBox, ClosedWallsKeepTheLight) {
    // Lattice rays go from point to point and are never interpolated: what leaks is what the last step mixes.
    for (const double wall : {1.0, 2.0, 4.0})
        for (const Quality quality : kQualities) {
            Scene scene = with(hrc_canvas(96, 96, quality),
                               {shape(Circle{{46.3, 49.2}, 5}, Colour(1)),
                                shape(Polyline{{{26.4, 27.3}, {68.2, 25.1}, {70.6, 66.4}, {24.3, 69.7}}, wall, true})});
            const ImageF picture = render_linear(scene);
            double most = 0;
            for (int y = 0; y < 96; ++y)
                for (int x = 0; x < 96; ++x) {
                    if (x > 19 && x < 76 && y > 20 && y < 75) continue;  // the box and its walls
                    most = std::max(most, double(picture.at(x, y)[0]));
                }
            const double inside = double(picture.at(46, 38)[0]);
            std::printf("box of walls %g px, quality %d: at most %.2e outside, %.3f inside\n", wall, int(quality), most, inside);
            EXPECT_GT(inside, 0.1);
            EXPECT_LE(most, 1e-6) << wall << " " << int(quality);
        }
}

TEST(HrcMargin, LampsOutsideOfTheViewShineIntoIt) {
    for (const Quality quality : kQualities) {
        Scene scene = with(hrc_canvas(48, 32, quality), {shape(Circle{{-9, 16.3}, 5}, Colour(1)), shape(Circle{{24.2, 45}, 4}, Colour(2))});
        EXPECT_EQ(largest(render_linear(scene)), 0) << "outside of the domain";
        scene.canvas.margin = 18;
        const ImageF near = render_linear(scene);
        // At (4.5, 16.5) the first lamp fills asin(5 / 13.5) / pi of the circle, the second asin(4 / 34.6) / pi.
        const double wanted = std::asin(5 / 13.5) / std::numbers::pi + 2 * std::asin(4 / std::hypot(19.7, 28.5)) / std::numbers::pi;
        EXPECT_NEAR(near.at(4, 16)[0] / wanted, 1, 0.06) << int(quality);
        // The same scene all in view.
        Scene wide = hrc_canvas(84, 68, quality);
        wide.shapes = {shape(Circle{{9, 34.3}, 5}, Colour(1)), shape(Circle{{42.2, 63}, 4}, Colour(2))};
        const ImageF all = crop(render_linear(wide), 18, 18, 48, 32);
        // The lattice lies otherwise, so other rays meet the lamps.
        EXPECT_LE(difference(near, all).mean, (quality == Quality::draft ? 0.06 : 0.03) * mean(all)) << int(quality);
    }
}

TEST(HrcLight, DoubledDoublesEveryValueExactlyAndRendersAreRepeatable) {
    for (const Quality quality : kQualities) {
        Scene scene = hrc_canvas(64, 48, quality);
        scene.shapes = lamps_and_walls({32, 24}, 24, [](Point p) { return p; }, 0, false);
        scene.sky.radiance = {0.03, 0.01, 0.02};
        const ImageF once = render_linear(scene);
        EXPECT_EQ(render_linear(scene).data, once.data);  // the list of rays is in no order; the picture does not show it
        for (Shape& s : scene.shapes) s.emission *= 2;
        scene.sky.radiance *= 2;
        const ImageF twice = render_linear(scene);
        for (std::size_t i = 0; i < once.data.size(); ++i) ASSERT_EQ(twice.data[i], 2 * once.data[i]);
    }
}

TEST(HrcLight, ADiscInTheOpenGivesWhatTheFormulaSays) {
    for (const auto& [quality, bound] : {std::pair(Quality::draft, 0.05), std::pair(Quality::standard, 0.025), std::pair(Quality::high, 0.015)}) {
        const Scene scene = with(hrc_canvas(128, 128, quality), {shape(Circle{{64.3, 63.8}, 10}, Colour(1))});
        const ImageF picture = render_linear(scene);
        double error = 0, energy = 0, sum = 0;
        int pixels = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x) {
                const double r = std::hypot(x + 0.5 - 64.3, y + 0.5 - 63.8);
                if (r < 15 || r > 60) continue;
                const double wanted = std::asin(10 / r) / std::numbers::pi;
                error += std::abs(double(picture.at(x, y)[0]) / wanted - 1);
                energy += double(picture.at(x, y)[0]);
                sum += wanted;
                ++pixels;
            }
        std::printf("disc, quality %d: mean relative error %.4f, energy %.4f\n", int(quality), error / pixels, energy / sum);
        EXPECT_LE(error / pixels, bound);
        EXPECT_NEAR(energy / sum, 1, 0.01);
    }
}

}  // namespace
}  // namespace penumbra::test
