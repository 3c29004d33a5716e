// SPDX-License-Identifier: MIT
// The method `hybrid`: the brightest lamps solved, the rest sampled; their sum is the picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/plan/plan.h"
#include "core/plan/split_lights.h"
#include "core/plan/support.h"
#include "core/reference/solver.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

Scene by(Scene scene, const char* method, Quality quality = Quality::standard) {
    scene.render.method = method;
    scene.render.quality = quality;
    return scene;
}

// A few lanterns and many weak lamps among things that cast shadows; `weak` lamps are this bright.
Scene meadow(double weak, int things = 330, int width = 240, int height = 160) {
    Numbers numbers(11);
    Scene scene = canvas(width, height);
    scene.sky.radiance = {0.01, 0.02, 0.04};
    for (int i = 0; i < things; ++i) {
        const Point at{numbers.between(0, width), numbers.between(0, height)};
        if (i < 3) scene.shapes.push_back(shape(Circle{at, 2.5}, Colour(60, 45, 20)));
        else if (i < 90) scene.shapes.push_back(shape(Circle{at, 0.6}, Colour(weak, 2 * weak, weak)));
        else scene.shapes.push_back(shape(Ellipse{at, {1.3, 0.4}, numbers.between(0, 180)}));
    }
    return scene;
}

struct Errors {
    double nrmse = 0, rel = 0;
};

// At every third pixel.
Errors errors_of(const Scene& scene, const ImageF& picture) {
    reference::ExactSolver solver(scene);
    double mean = 0, squares = 0, relative = 0;
    std::vector<std::pair<double, double>> pairs;
    for (int y = 1; y < picture.height; y += 3)
        for (int x = 1; x < picture.width; x += 3) {
            const Point p{x + 0.5, y + 0.5};
            if (solver.is_solid(p)) continue;
            pairs.emplace_back(double(picture.at(x, y)[1]), solver.value(p).g);
            mean += pairs.back().second;
        }
    mean /= double(pairs.size());
    for (const auto& [a, b] : pairs) {
        squares += (a - b) * (a - b);
        relative += std::abs(a - b) / (b + 0.05 * mean);
    }
    return {std::sqrt(squares / double(pairs.size())) / mean, relative / double(pairs.size())};
}

TEST(Hybrid, IsTheSumOfWhatIsSolvedAndWhatIsSampled) {
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) {
        const Scene scene = by(meadow(0.2, 500), "hybrid", quality);
        const Plan plan = make_plan(scene, {});
        ASSERT_FALSE(plan.solved_shapes.empty());
        ASSERT_LT(plan.solved_shapes.size(), 90u) << "nothing is left to sample: this test needs another scene";
        EXPECT_TRUE(plan.exact.used);
        EXPECT_TRUE(plan.hrc.active());
        const ImageF both = render_linear(scene);
        const ImageF solved = render_linear(by(solved_part(scene, plan.solved_shapes), "exact", quality));
        const ImageF sampled = render_linear(by(sampled_part(scene, plan.solved_shapes), "hrc", quality));
        const reference::ExactSolver solver(scene);
        const double floor = 1e-6 * mean(both);
        for (int y = 0; y < both.height; ++y)
            for (int x = 0; x < both.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    if (solver.is_solid({x + 0.5, y + 0.5})) continue;
                    const double sum = double(solved.at(x, y)[c]) + double(sampled.at(x, y)[c]);
                    ASSERT_NEAR(both.at(x, y)[c], sum, 1e-6 * sum + floor) << x << ", " << y;
                }
    }
}

TEST(Hybrid, SolidsShowTheirOwnLight) {
    Scene scene = by(with(canvas(40, 40), {shape(Circle{{12, 20}, 5}, {3, 2, 1}), shape(Circle{{30, 20}, 5}, {1, 2, 3})}), "hybrid");
    scene.sky.radiance = Colour(0.1);
    const ImageF picture = render_linear(scene);
    EXPECT_FLOAT_EQ(picture.at(12, 20)[0], 3.0f);
    EXPECT_FLOAT_EQ(picture.at(30, 20)[2], 3.0f);
}

TEST(Hybrid, ErrsATenthOfWhatSamplingDoes) {
    const Scene scene = meadow(0.02, 500);
    const Errors sampled = errors_of(scene, render_linear(by(scene, "hrc")));
    const Errors hybrid = errors_of(scene, render_linear(by(scene, "hybrid")));
    std::printf("hrc %.4f %.4f, hybrid %.4f %.4f\n", sampled.nrmse, sampled.rel, hybrid.nrmse, hybrid.rel);
    EXPECT_LT(hybrid.nrmse, 0.1 * sampled.nrmse);
    EXPECT_LT(hybrid.rel, 0.1 * sampled.rel);
}

TEST(Hybrid, IsExactWhereAllLampsAreSolved) {
    Scene scene = meadow(0.2, 40);
    scene.sky = {};
    const RenderResult result = shared_renderer().render(by(scene, "hybrid"));
    EXPECT_TRUE(std::any_of(result.stats.skipped.begin(), result.stats.skipped.end(), [](const SkippedWork& s) { return s.what == "ray pieces"; }));
    EXPECT_EQ(render_linear(by(scene, "hybrid")).data, render_linear(by(scene, "exact")).data);
}

TEST(Hybrid, WithoutLampsTheSkyIsSampled) {
    Scene scene = with(canvas(60, 50), {shape(Rect{{30, 25}, {20, 4}, 30, 0})});
    scene.sky.radiance = {0.2, 0.3, 0.5};
    EXPECT_EQ(render_linear(by(scene, "hybrid")).data, render_linear(by(scene, "hrc")).data);
}

TEST(Hybrid, LightsWithoutASizeAreAdded) {
    Scene scene = meadow(0.2, 200);
    PointLight lamp;
    lamp.position = {60, 50};
    lamp.intensity = Colour(40);
    const ImageF without = render_linear(by(scene, "hybrid"));
    scene.lights.push_back(lamp);
    const ImageF with_light = render_linear(by(scene, "hybrid"));
    Scene alone = scene;
    alone.sky = {};
    for (Shape& one : alone.shapes) one.emission = Colour(0);
    const ImageF light = render_linear(by(alone, "exact"));
    const double floor = 1e-5 * mean(with_light);
    for (std::size_t i = 0; i < light.data.size(); ++i) {
        if (without.data[i] <= 0 || light.data[i] <= 0) continue;
        ASSERT_NEAR(with_light.data[i], without.data[i] + light.data[i], 1e-5 * with_light.data[i] + floor);
    }
}

TEST(Hybrid, AutoTakesItForAFewBrightLampsAmongMany) {
    Scene scene = by(meadow(0.02, 2600, 400, 300), "auto");
    const Plan plan = make_plan(scene, {});
    EXPECT_EQ(plan.method, "hybrid") << plan.method_reason;
    EXPECT_NE(plan.method_reason.find("the brightest 3,"), std::string::npos) << plan.method_reason;
    for (Shape& one : scene.shapes)
        if (one.emission != Colour(0)) one.emission = Colour(1);
    EXPECT_EQ(make_plan(scene, {}).method, "hrc") << "all lamps are alike";
    EXPECT_EQ(make_plan(scene, {}, "too dense").method, "hrc");
    scene.shapes.resize(50);
    EXPECT_EQ(make_plan(scene, {}).method, "exact");
}

TEST(Hybrid, TheBrightestAreSolved) {
    const LightSplit lanterns = split_lights(meadow(0.02, 700, 400, 300), 20'000);
    EXPECT_EQ(lanterns.solved.size(), 3u);
    EXPECT_GE(lanterns.share, least_solved_share());
    EXPECT_LE(lanterns.cost, most_solved_cost(Quality::standard));
    EXPECT_FALSE(lanterns.all());
    const LightSplit few = split_lights(meadow(0.2, 40), 20'000);
    EXPECT_TRUE(few.all());
    EXPECT_NEAR(few.share, 1, 1e-12);
    // All alike and too many: as many as may be.
    Scene alike = meadow(0.2, 2000, 400, 300);
    for (Shape& one : alike.shapes) one.emission = Colour(1);
    const LightSplit some = split_lights(alike, 20'000);
    EXPECT_GE(some.solved.size(), 1u);
    EXPECT_LT(some.share, least_solved_share());
    EXPECT_TRUE(split_lights(meadow(0.2), 10).solved.empty()) << "too many pieces";
}

// What `auto` takes is what the method by its name does.
TEST(Hybrid, IsTheSameByChoiceAndByName) {
    const Scene scene = meadow(0.02, 2600, 400, 300);
    ASSERT_EQ(make_plan(by(scene, "auto"), {}).method, "hybrid");
    EXPECT_EQ(make_plan(by(scene, "auto"), {}).solved_shapes, make_plan(by(scene, "hybrid"), {}).solved_shapes);
}

TEST(Hybrid, WhatItCannotDoIsRefused) {
    Scene scene = by(with(canvas(30, 30), {shape(Circle{{15, 15}, 4}, Colour(1))}), "hybrid");
    EXPECT_TRUE(unsupported(scene).empty());
    scene.render.bounces = 1;
    EXPECT_TRUE(unsupported(scene).empty()) << "nothing reflects";
    scene.shapes[0].albedo = Colour(0.5);
    ASSERT_EQ(unsupported(scene).size(), 1u);
    EXPECT_EQ(unsupported(scene)[0].pointer, "/render/bounces");
    scene.render.bounces = 0;
    scene.shapes[0].medium = Medium{};
    ASSERT_EQ(unsupported(scene).size(), 1u);
    EXPECT_EQ(unsupported(scene)[0].pointer, "/render/method");
}

}  // namespace
}  // namespace penumbra::test
