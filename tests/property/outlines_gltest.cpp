// SPDX-License-Identifier: MIT
// Paths, texts and polygons of several rings, from the scene's text to the picture, by every method: against closed forms, and against
// the exact solver. A row of a picture as the sky.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/reference/solver.h"
#include "server/json/scene_json.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"
#include "tests/unit/test_scenes.h"

namespace penumbra::test {
namespace {

Scene parsed(const std::string& rest, int width = 64, int height = 48) {
    const std::string text = R"({"version": 1, "canvas": {"width": )" + std::to_string(width) + R"(, "height": )" + std::to_string(height) +
                             "}, " + rest + "}";
    ParsedScene result = parse_scene(text);
    for (const LocatedProblem& problem : result.problems) ADD_FAILURE() << to_string(problem);
    return result.scene.value_or(canvas(width, height));
}

// Largest difference from the exact solver over free pixels, relative to the mean.
double off_truth(const Scene& scene) {
    const reference::Solution solution = reference::solve(scene);
    EXPECT_TRUE(solution.problems.empty());
    const ImageF picture = render_linear(scene);
    double sum = 0, squares = 0;
    int count = 0;
    for (std::size_t i = 0; i < picture.data.size(); ++i) {
        const double truth = double(solution.image.data[i]);
        if (std::isnan(truth)) continue;
        sum += truth;
        squares += (double(picture.data[i]) - truth) * (double(picture.data[i]) - truth);
        ++count;
    }
    EXPECT_GT(count, 0);
    return std::sqrt(squares / count) / (sum / count);
}

struct Method {
    const char* name;
    double nrmse;  // bound on the error of these scenes
};
const Method kMethods[] = {{"exact", 0.02}, {"reference", 0.2}, {"hrc", 0.25}, {"rc", 0.3}, {"rc_fix", 0.3}};

// A ring that shines: within its hole the same from everywhere, phi = L; outside its disc asin(R / r) / pi of it.
const char* const kRing = R"("shapes": [{"type": "path", "emission": [2, 1, 0.5], "fill_rule": "evenodd",
    "d": "M12.3 24.1a14 14 0 1 0 28 0a14 14 0 1 0-28 0z M18.3 24.1a8 8 0 1 0 16 0a8 8 0 1 0-16 0z"}])";

TEST(Outlines, AFurnaceInsideARing) {
    for (const Method& method : kMethods) {
        Scene scene = parsed(kRing);
        scene.render.method = method.name;
        const ImageF picture = render_linear(scene);
        for (int y = 19; y < 29; ++y)
            for (int x = 21; x < 31; ++x)
                if (std::hypot(x + 0.5 - 26.3, y + 0.5 - 24.1) < 6) {
                    EXPECT_NEAR(picture.at(x, y)[0], 2, 2e-3) << method.name << " " << x << " " << y;
                }
        double measured = 0, expected = 0;
        for (int x = 44; x < 64; ++x) {
            measured += double(picture.at(x, 24)[1]);
            expected += std::asin(14 / std::hypot(x + 0.5 - 26.3, 24.5 - 24.1)) / std::numbers::pi;
        }
        EXPECT_NEAR(measured / expected, 1, std::string(method.name) == "exact" ? 2e-3 : 0.1) << method.name;
        EXPECT_LT(off_truth(scene), method.nrmse) << method.name;
    }
}

TEST(Outlines, ARingOfTwoPolygonsIsTheSameAsOneWithASeam) {
    Polygon rings{{{10.2, 8.1}, {50.3, 8.1}, {50.3, 40.2}, {10.2, 40.2}, {20.1, 15.2}, {20.1, 30.1}, {40.2, 30.1}, {40.2, 15.2}}, {4}};
    Polygon seam{{{10.2, 8.1}, {50.3, 8.1}, {50.3, 40.2}, {10.2, 40.2}, {10.2, 8.1}, {20.1, 15.2}, {20.1, 30.1}, {40.2, 30.1}, {40.2, 15.2}, {20.1, 15.2}}};
    for (const Method& method : kMethods) {
        Scene a = with(canvas(64, 48), {shape(rings, {1, 2, 3}), shape(Circle{{30.1, 22.3}, 3})});
        Scene b = with(canvas(64, 48), {shape(seam, {1, 2, 3}), shape(Circle{{30.1, 22.3}, 3})});
        a.sky.radiance = b.sky.radiance = Colour(0.2);
        a.render.method = b.render.method = method.name;
        EXPECT_LT(difference(render_linear(a), render_linear(b)).max, 5e-3) << method.name;
        EXPECT_LT(off_truth(a), method.nrmse) << method.name;
    }
}

TEST(Outlines, ACircleOfAPathIsTheCircle) {
    const Scene path = parsed(R"("shapes": [{"type": "path", "emission": 3, "d": "M20.3 24.1a10 10 0 1 0 20 0a10 10 0 1 0-20 0"}])");
    const Scene circle = parsed(R"("shapes": [{"type": "circle", "emission": 3, "center": [30.3, 24.1], "radius": 10}])");
    // Within the tolerance of a twentieth of a pixel on ten.
    const ImageF a = render_linear(path), b = render_linear(circle);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const double d = std::hypot(x + 0.5 - 30.3, y + 0.5 - 24.1) - 10;
            if (std::abs(d) > 0.06) {
                EXPECT_NEAR(a.at(x, y)[0], b.at(x, y)[0], d < 1 ? 0.1 : 0.02) << x << " " << y;
            }
        }
}

TEST(Outlines, WhatOverlapsShowsNoSeam) {
    // Two squares and a star by the nonzero rule: solid throughout, smooth edges or not.
    Scene scene = parsed(R"("shapes": [{"type": "path", "emission": 0.5, "d": "M8 8h24v24h-24z M20 16h30v20h-30z"}])");
    const Image8 picture = render_display(scene);
    for (int y = 9; y < 31; ++y)
        for (int x = 9; x < 49; ++x) {
            const bool within = x < 31 || (y >= 17 && x >= 21);
            if (within) {
                EXPECT_EQ(picture.at(x, y)[1], 188) << x << " " << y;
            }
        }
}

TEST(Outlines, TextsShineAsTheSolverSays) {
    for (const Method& method : kMethods) {
        Scene scene = parsed(R"("shapes": [{"type": "text", "text": "Bo", "position": [32, 40], "size": 40, "anchor": "middle", "emission": [3, 2, 1]}])");
        scene.render.method = method.name;
        EXPECT_LT(off_truth(scene), method.nrmse) << method.name;
        // The hole of the o is lit by its letter from all sides.
        const ImageF picture = render_linear(scene);
        double brightest = 0;
        for (int x = 36; x < 60; ++x) brightest = std::max(brightest, double(picture.at(x, 29)[1]));
        EXPECT_NEAR(brightest, 2, 2e-2) << method.name;
    }
}

TEST(SkyPicture, OfAnOpenCanvasIsItsMean) {
    Image8 row(5, 1, 3);
    double sum[3] = {};
    for (int x = 0; x < 5; ++x)
        for (int c = 0; c < 3; ++c) {
            row.at(x, 0)[c] = std::uint8_t(x * 50 + c * 20);
            sum[c] += 2 * srgb_decode(x * 50 + c * 20) / 5;
        }
    for (const Method& method : kMethods) {
        Scene scene = parsed(R"("sky": {"scale": 2, "image": ")" + data_url(encode_png(row)) + "\"}", 16, 12);
        scene.render.method = method.name;
        const ImageF picture = render_linear(scene);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(double(picture.at(7, 5)[c]), sum[c], 2e-3 * sum[c]) << method.name;
    }
}

TEST(SkyPicture, GoesRoundClockwiseFromTheRight) {
    // White where one looks down (0 to 180 degrees), black where up; a wall across lets each side see its own half.
    Image8 row(256, 1, 3);
    for (int x = 0; x < 128; ++x)
        for (int c = 0; c < 3; ++c) row.at(x, 0)[c] = 255;
    const Scene scene = parsed(R"("shapes": [{"type": "rect", "center": [32, 24], "size": [20000, 4]}], "sky": {"image": ")" +
                               data_url(encode_png(row)) + "\"}");
    const ImageF picture = render_linear(scene);
    // Above the wall (it ends with the domain, 32.5 to the left and 31.5 to the right, 9.5 below), white shows past its ends only.
    const double past = (std::atan(9.5 / 32.5) + std::atan(9.5 / 31.5)) / (2 * std::numbers::pi);
    EXPECT_NEAR(double(picture.at(32, 12)[0]), past, 0.005);
    EXPECT_NEAR(double(picture.at(32, 36)[0]), 0.5, 0.005);
}

}  // namespace
}  // namespace penumbra::test
