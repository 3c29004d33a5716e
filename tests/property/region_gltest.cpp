// SPDX-License-Identifier: MIT
// A part of the canvas is the crop of the whole picture: to the byte by `exact`, `hrc`, `hybrid`, `reference` and where the picture is
// constant; by `rc` and `rc_fix`, whose textures are smaller, but for the rounding of texture coordinates.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

Scene lit_scene(int width, int height) {
    Scene scene = canvas(width, height);
    scene.canvas.margin = 9.5;
    scene.sky.radiance = {0.02, 0.05, 0.1};
    scene.shapes = {shape(Circle{{0.3 * width, 0.4 * height}, 9}, Colour(4, 3, 2)), shape(Rect{{0.6 * width, 0.5 * height}, {30, 6}, 25, 1}),
                    shape(Polygon{{{20, 20}, {50, 30}, {25, 60}}}, Colour(0, 0, 1)), shape(Ellipse{{0.8 * width, 0.2 * height}, {14, 6}, 70}),
                    shape(Circle{{width + 4.0, 30}, 6}, Colour(2))};
    return scene;
}

void expect_crop(Scene scene, PixelRect region, double bound, const std::string& what) {
    const ImageF linear = crop(render_linear(scene), region.x, region.y, region.w, region.h);
    const Image8 shown = crop(render_display(scene), region.x, region.y, region.w, region.h);
    scene.canvas.region = region;
    const ImageF part = render_linear(scene);
    ASSERT_EQ(part.width, region.w) << what;
    ASSERT_EQ(part.height, region.h) << what;
    if (bound <= 0) {
        EXPECT_EQ(part.data, linear.data) << what;
        EXPECT_EQ(render_display(scene).data, shown.data) << what;
    } else {
        const double floor = 0.05 * mean(linear);
        for (std::size_t i = 0; i < part.data.size(); ++i)
            ASSERT_NEAR(part.data[i], linear.data[i], bound * (linear.data[i] + floor)) << what;
        EXPECT_LE(difference(render_display(scene), shown).max, 1) << what;
    }
    const RenderStats stats = shared_renderer().render(scene).stats;
    EXPECT_EQ(stats.width, region.w);
    EXPECT_EQ(stats.height, region.h);
}

TEST(Region, IsTheCropOfThePicture) {
    for (const char* method : {"exact", "hrc", "hybrid", "rc", "rc_fix", "reference", "auto"}) {
        for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) {
            if (quality != Quality::standard && std::string(method) != "rc" && std::string(method) != "exact") continue;
            Scene scene = lit_scene(118, 91);
            scene.render.method = method;
            scene.render.quality = quality;
            const std::string name = method + std::string(", quality ") + std::to_string(int(quality));
            const double bound = std::string(method) == "rc" || std::string(method) == "rc_fix" ? 1e-3 : 0;
            expect_crop(scene, {0, 0, 118, 91}, 0, name + ", all of it");
            expect_crop(scene, {37, 41, 33, 19}, bound, name + ", inside");
            expect_crop(scene, {90, 70, 28, 21}, bound, name + ", a corner");
            expect_crop(scene, {44, 46, 1, 1}, bound, name + ", one pixel");
        }
    }
}

TEST(Region, OfAGradientABitmapAndAConstantPicture) {
    Scene scene = lit_scene(90, 80);
    scene.sky.gradient = {{0, Colour(0.1)}, {120, Colour(0.5, 0.2, 0)}, {300, Colour(0, 0.1, 0.4)}};
    scene.shapes.push_back(shape(Bitmap{picture(4, 4, [](int x, int y) { return x != y; }), {40, 40}, {22, 18}}));
    for (const char* method : {"exact", "rc"}) {
        scene.render.method = method;
        expect_crop(scene, {31, 22, 40, 41}, std::string(method) == "rc" ? 1e-3 : 0, method);
    }
    scene.shapes.clear();
    expect_crop(scene, {31, 22, 40, 41}, 0, "a gradient alone");
}

// The bands that `exact` solves a tall canvas in: parts in one, across two, and in the last.
TEST(Region, AcrossTheBandsOfATallCanvas) {
    Scene scene = lit_scene(1024, 4200);
    scene.render.method = "exact";
    scene.render.quality = Quality::draft;
    const ImageF whole = render_linear(scene);
    for (const int y : {700, 2030, 4150}) {
        scene.canvas.region = PixelRect{300, y, 70, 50};
        EXPECT_EQ(render_linear(scene).data, crop(whole, 300, y, 70, 50).data) << y;
    }
}

TEST(Region, CostsLessThanThePicture) {
    Scene scene = lit_scene(600, 600);
    for (const char* method : {"exact", "rc"}) {
        scene.render.method = method;
        const auto work = [&] {
            double sum = 0;
            for (const PassStats& pass : shared_renderer().render(scene).stats.passes) sum += double(pass.rays + pass.points);
            return sum;
        };
        scene.canvas.region.reset();
        const double all = work();
        scene.canvas.region = PixelRect{200, 200, 60, 60};
        EXPECT_LT(work(), 0.25 * all) << method;
    }
}

}  // namespace
}  // namespace penumbra::test
