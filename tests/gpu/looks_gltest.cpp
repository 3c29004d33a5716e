// SPDX-License-Identifier: MIT
// Debug views of what methods do on their way: that their numbers are those of the frame, not only that they draw.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/vector_int2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/compare/error_figures.h"
#include "core/error_view.h"
#include "core/plan/plan.h"
#include "core/plan/support.h"
#include "core/reference/solver.h"
#include "core/views/canvas.h"
#include "core/views/light_views.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr double kPi = std::numbers::pi;

Image8 view_of(Scene scene, const std::string& view, const char* method) {
    scene.render.view = view;
    scene.render.method = method;
    return render_display(scene);
}

// Beyond the legend, whose box begins here at the latest.
int above_legend(const Image8& picture) { return picture.height - 50; }

// The light that pixels of a view of light show, as shares of white.
double shown(const Image8& picture, int x, int y, int channel = 0) { return srgb_decode(picture.at(x, y)[channel]); }

TEST(Looks, ACascadeBringsTheLightFromItsIntervalOn) {
    // A small lamp in a corner: what is nearer than the cascade's start is dark, what is farther sees all of it.
    const Point lamp(30, 30);
    const Scene scene = with(canvas(240, 240), {shape(Circle{lamp, 8}, Colour(2))});
    const std::vector<CascadePlan> cascades = plan_cascades({240, 240}, std::hypot(240.0, 240.0), cascade_settings(Quality::standard));
    ASSERT_GT(cascades.size(), 4u);
    for (const int level : {2, 3}) {
        const CascadePlan& c = cascades[static_cast<std::size_t>(level)];
        const Image8 picture = view_of(scene, "cascade" + std::to_string(level), "rc");
        const double reach = c.start - 10 - c.spacing;
        std::vector<double> whites;
        for (int i = 0; i < 180; ++i) {
            const int x = 30 + i, y = 30 + i / 2;
            if (y >= above_legend(picture)) break;
            // The light at the nearest probe.
            const Point probe = c.first_probe + glm::round((glm::dvec2(x + 0.5, y + 0.5) - c.first_probe) / c.spacing) * c.spacing;
            const double far = std::hypot(probe.x - lamp.x, probe.y - lamp.y);
            if (far < reach && far > 12) {
                EXPECT_EQ(picture.at(x, y)[0], 0) << level << " at " << x;
            }
            const double light = 2 * std::asin(8 / far) / kPi;
            if (far > c.start + 10) whites.push_back(light / shown(picture, x, y));
        }
        ASSERT_GT(whites.size(), 40u);
        // What white is, told from each pixel: one number, within the cascade's angular error.
        std::nth_element(whites.begin(), whites.begin() + static_cast<std::ptrdiff_t>(whites.size() / 2), whites.end());
        const double white = whites[whites.size() / 2];
        const auto off = std::count_if(whites.begin(), whites.end(), [&](double w) { return std::abs(w / white - 1) > 0.25; });
        EXPECT_LT(off, static_cast<std::ptrdiff_t>(whites.size() / 5)) << level;
    }
}

TEST(Looks, LevelZeroOfHrcIsThePicture) {
    Scene scene = with(canvas(120, 120), {shape(Circle{{30, 30}, 8}, {2, 1, 0.5}), shape(Rect{{70, 40}, {6, 30}, 20, 0})});
    scene.sky.radiance = Colour(0.05);
    const Image8 view = view_of(scene, "cascade0", "hrc");
    scene.render.method = "hrc";
    const ImageF picture = render_linear(scene);
    double white = 0;
    int count = 0;
    for (int y = 4; y < above_legend(view); ++y)
        for (int x = 4; x < 116; ++x)
            if (view.at(x, y)[0] > 60 && view.at(x, y)[0] < 255 && picture.at(x, y)[0] < 0.5f && picture.at(x, y)[0] > 0) white += double(picture.at(x, y)[0]) / shown(view, x, y), ++count;
    ASSERT_GT(count, 500);
    white /= count;
    double off = 0;
    for (int y = 4; y < above_legend(view); ++y)
        for (int x = 4; x < 116; ++x)
            if (view.at(x, y)[0] > 60 && view.at(x, y)[0] < 255 && picture.at(x, y)[0] < 0.5f && picture.at(x, y)[0] > 0)
                off += std::abs(shown(view, x, y) * white / double(picture.at(x, y)[0]) - 1) / count;
    EXPECT_LT(off, 0.04) << "but for the blur over neighbours";
    // A uniform sky is the same at every level.
    Scene open = with(canvas(120, 120), {shape(Circle{{116, 116}, 1})});
    open.sky.radiance = Colour(0.7);
    for (const char* level : {"cascade0", "cascade3"}) {
        const Image8 sky = view_of(open, level, "hrc");
        for (int i = 0; i < 60; ++i) EXPECT_GE(sky.at(i, 5 + i / 2)[1], 252) << level;
    }
}

TEST(Looks, ProbesShowWhereTheirLightComesFrom) {
    // A bright wall on the right: each probe's wedges to the right shine, those to the left do not.
    Scene scene = with(canvas(256, 192), {shape(Rect{{250, 96}, {8, 190}, 0, 0}, Colour(3))});
    const Image8 picture = view_of(scene, "probes", "rc");
    const std::vector<CascadePlan> cascades = plan_cascades({256, 192}, std::hypot(256.0, 192.0), cascade_settings(Quality::standard));
    const auto shown_one = std::find_if(cascades.begin(), cascades.end(), [](const CascadePlan& c) { return c.spacing >= 14; });
    ASSERT_NE(shown_one, cascades.end());
    const double s = shown_one->spacing;
    int bright = 0, dark = 0, probes = 0;
    for (int j = 1; j < 6; ++j)
        for (int i = 1; i < 12; ++i) {
            const glm::dvec2 at = shown_one->first_probe + s * glm::dvec2(i, j);
            // This cascade sees what its interval and those above it reach.
            if (at.y > 130 || 246 - at.x < shown_one->start + 4) continue;
            ++probes;
            bright += picture.at(int(at.x + 0.35 * s), int(at.y))[1] > 200;
            dark += picture.at(int(at.x - 0.35 * s), int(at.y))[1] == 0;
            const double middle = shown(picture, int(at.x), int(at.y), 1);
            EXPECT_GT(middle, 0.02);
            EXPECT_LT(middle, 0.6) << "the mean of all directions";
        }
    EXPECT_GT(probes, 5);
    EXPECT_EQ(bright, probes);
    EXPECT_EQ(dark, probes);
}

// What the march of `rc` does (glsl/lib/march.glsl) beside one disc, counted here.
int steps_of_ray(Point p, Point d, double start, double end, const Circle& disc, Point size) {
    const auto exit = [&](int axis) { return d[axis] > 0 ? (size[axis] - p[axis]) / d[axis] : d[axis] < 0 ? -p[axis] / d[axis] : 1e30; };
    const double leave = std::min(exit(0), exit(1)), stop = std::min(end, leave);
    const auto distance = [&](Point q) { return std::hypot(q.x - disc.center.x, q.y - disc.center.y) - disc.radius; };
    int steps = 0;
    for (double t = start; t < stop;) {
        ++steps;
        const Point at = p + d * t;
        const Point centre(std::clamp(std::floor(at.x), 0.0, size.x - 1) + 0.5, std::clamp(std::floor(at.y), 0.0, size.y - 1) + 0.5);
        const double room = distance(centre);
        if (room >= 1.5) {
            t += room - 0.7072;
            continue;
        }
        const double exact = distance(at);
        if (exact <= 0) break;
        const double step = std::clamp(exact, 0.25, 0.7072);
        t = t + step >= stop && t < stop - 0.01 ? stop - 0.005 : t + step;
    }
    return steps;
}

TEST(Looks, StepsAreThoseOfTheMarch) {
    const glm::ivec2 size(64, 120);
    const Circle disc{{40.3, 30.2}, 5};
    const Image8 picture = view_of(with(canvas(size.x, size.y), {shape(disc, Colour(1))}), "steps", "rc");
    const std::vector<CascadePlan> cascades = plan_cascades(size, std::hypot(size.x, size.y), cascade_settings(Quality::standard));
    const auto is_free = [&](Point p) { return std::hypot(p.x - disc.center.x, p.y - disc.center.y) > disc.radius; };
    std::vector<float> expected(static_cast<std::size_t>(size.x * size.y), 0);
    for (const CascadePlan& c : cascades) {
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::ivec2 index = glm::clamp(glm::ivec2(glm::round((glm::dvec2(x + 0.5, y + 0.5) - c.first_probe) / c.spacing)), glm::ivec2(0), c.probes - 1);
                const Point p = c.first_probe + glm::dvec2(index) * c.spacing;
                if (!is_free(p)) continue;
                int steps = 0;
                for (int k = 0; k < c.directions(); ++k) {
                    const double angle = 2 * kPi * (k + 0.5) / c.directions();
                    steps += steps_of_ray(p, {std::cos(angle), std::sin(angle)}, c.start, c.end, disc, Point(size));
                }
                expected[static_cast<std::size_t>(y * size.x + x)] += static_cast<float>(steps / (c.spacing * c.spacing));
            }
    }
    const float most = *std::max_element(expected.begin(), expected.end());
    double off = 0;
    int count = 0;
    for (int y = 0; y < above_legend(picture); ++y)
        for (int x = 0; x < size.x; ++x, ++count) {
            const glm::dvec3 colour = heat(double(expected[static_cast<std::size_t>(y * size.x + x)]) / double(most));
            for (int k = 0; k < 3; ++k) off += std::abs(picture.at(x, y)[k] - 255 * colour[k]) / 3;
        }
    EXPECT_LT(off / count, 3) << "codes of 255, on average";
}

TEST(Looks, SkippedTellsTheCellsOfExact) {
    const Scene scene = with(canvas(128, 128), {shape(Circle{{40.3, 30.2}, 9}, Colour(1)), shape(Rect{{60, 44}, {5, 20}, 10, 0})});
    const Image8 picture = view_of(scene, "skipped", "exact");
    const auto is = [&](int x, int y, double share) {
        const glm::dvec3 colour = heat(share);
        return std::abs(picture.at(x, y)[0] - 255 * colour[0]) < 1.5 && std::abs(picture.at(x, y)[2] - 255 * colour[2]) < 1.5;
    };
    const double largest = 1 - 1.0 / 64;
    int solved = 0, others = 0, coarse = 0;
    for (int y = 0; y < above_legend(picture); ++y)
        for (int x = 0; x < 128; ++x) {
            bool known = false;
            for (const int side : {1, 2, 4, 8}) known = known || is(x, y, (1 - 1.0 / (side * side)) / largest);
            EXPECT_TRUE(known) << x << " " << y;
            (is(x, y, 0) ? solved : others) += 1;
            coarse += is(x, y, 1);
        }
    EXPECT_GT(solved, 100);
    EXPECT_GT(others, 2 * solved);
    EXPECT_TRUE(is(40, 20, 0)) << "beside an outline every pixel is solved";
    EXPECT_GT(coarse, 500) << "one in 64 is solved, where nothing is near";
}

// Light adds up; but for the limiter of elements' slopes, which is not linear.
TEST(Looks, WhatEachThingGivesAddsUpToThePicture) {
    Scene scene = with(canvas(96, 80), {shape(Circle{{30, 30}, 6}, {2, 1, 0.5}), shape(Rect{{70, 40}, {6, 30}, 20, 0}, {0, 0.2, 0.4}), shape(Rect{{48, 70}, {60, 5}, 0, 0})});
    scene.shapes[2].albedo = Colour(0.6);
    Shape fog = shape(Circle{{60, 20}, 12});
    fog.medium = Medium{Colour(0.05), {0.01, 0, 0.02}};
    Scene misty = scene;
    misty.shapes.push_back(fog);
    scene.render.bounces = 2;
    for (Scene* one : {&scene, &misty}) {
        one->sky.radiance = Colour(0.05, 0.06, 0.07);
        one->lights = {PointLight{{20, 60}, {3, 2, 1}}, DirectionalLight{80, Colour(0.3)}, PointLight{{80, 15}, Colour(1), 2}};
        one->render.method = "rc";
        const ImageF whole = render_linear(*one);
        std::vector<std::string> views = {"sky", "light0", "light1", "light2"};
        for (std::size_t i = 0; i < one->shapes.size(); ++i) views.push_back("shape" + std::to_string(i));
        std::vector<double> sum(whole.data.size(), 0);
        for (const std::string& view : views) {
            one->render.view = view;
            const ImageF alone = render_linear(*one);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += double(alone.data[i]);
        }
        one->render.view = "final";
        for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_NEAR(sum[i], whole.data[i], 1e-3 * (0.05 + sum[i])) << i;
    }
    // A picture of eight bits says what it shows.
    EXPECT_EQ(view_of(scene, "light0", "rc").width, 96);
}

TEST(Looks, ErrorIsThatOfTheSolver) {
    Scene scene = with(canvas(96, 100), {shape(Circle{{30, 30}, 6}, Colour(2, 1, 0.5)), shape(Rect{{70, 40}, {6, 30}, 20, 0})});
    scene.sky.radiance = Colour(0.02);
    const Image8 view = view_of(scene, "error", "rc");
    scene.render.method = "rc";
    const ImageF picture = render_linear(scene), truth = reference::solve(scene).image;
    double mean = 0;
    int free = 0;
    for (const float value : truth.data)
        if (!std::isnan(value)) mean += double(value), ++free;
    mean /= free;
    double all = 0;
    for (int y = 0; y < above_legend(view); ++y)
        for (int x = 0; x < 96; ++x) {
            if (std::isnan(truth.at(x, y)[0])) {
                EXPECT_EQ(view.at(x, y)[0] + view.at(x, y)[1] + view.at(x, y)[2], 0);
                continue;
            }
            double error = 0;
            for (int c = 0; c < 3; ++c) error += std::abs(double(picture.at(x, y)[c]) - double(truth.at(x, y)[c])) / (double(truth.at(x, y)[c]) + 0.05 * mean) / 3;
            all += error;
            const glm::dvec3 colour = heat(error > 1e-4 ? std::log10(error / 1e-4) / 4 : 0);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(view.at(x, y)[c], 255 * colour[c], 2) << x << " " << y;
        }
    EXPECT_GT(all / free, 0.005);
    // The method that solves has hardly any.
    const Image8 solved = view_of(scene, "error", "exact");
    const glm::dvec3 low = heat(0.75);
    int bright = 0;
    for (int y = 0; y < above_legend(solved); ++y)
        for (int x = 0; x < 96; ++x) bright += solved.at(x, y)[1] > 255 * low[1];
    EXPECT_LT(bright, 60);
}

TEST(Looks, AreRefusedByNameWhereThereIsNoSuchThing) {
    const auto refusal = [](const char* view, const char* method) {
        Scene scene = with(canvas(64, 64, "png"), {shape(Circle{{30, 30}, 6}, Colour(1))});
        scene.lights = {PointLight{{5, 5}, Colour(1)}};
        scene.render.view = view;
        scene.render.method = method;
        const Problems problems = unsupported(scene);
        EXPECT_LE(problems.size(), 1u);
        return problems.empty() ? std::string() : problems[0].pointer + ": " + problems[0].message;
    };
    for (const char* view : {"cascade0", "cascade1", "probes", "steps", "skipped", "light0", "shape0", "sky", "error"}) {
        EXPECT_EQ(refusal(view, "rc"), "") << view;
        EXPECT_EQ(refusal(view, "rc_fix"), "") << view;
        EXPECT_EQ(refusal(view, "auto"), "") << view;
    }
    EXPECT_EQ(refusal("cascade2", "hrc"), "");
    EXPECT_EQ(refusal("skipped", "exact"), "");
    for (const char* method : {"exact", "reference"}) {
        EXPECT_NE(refusal("cascade0", method).find("/render/view: the view 'cascade0' is not supported here"), std::string::npos) << method;
        EXPECT_NE(refusal("probes", method).find(method), std::string::npos);
        EXPECT_NE(refusal("steps", method), "");
    }
    EXPECT_NE(refusal("probes", "hrc").find("no probes"), std::string::npos);
    EXPECT_NE(refusal("skipped", "reference"), "");
    EXPECT_NE(refusal("cascade15", "rc").find("cascade0 to cascade"), std::string::npos);
    EXPECT_NE(refusal("light1", "auto").find("light0 only"), std::string::npos);
    EXPECT_NE(refusal("shape7", "auto").find("shape0 only"), std::string::npos);
}

// Each has its legend, and is drawn of a part as of the whole.
TEST(Looks, HaveALegendAndMayBeCropped) {
    Scene scene = with(canvas(260, 200), {shape(Circle{{130, 60}, 20}, Colour(1)), shape(Circle{{200, 60}, 9})});
    for (const char* view : {"cascade1", "probes", "steps", "skipped", "shape0", "error"}) {
        const Image8 picture = view_of(scene, view, "rc");
        int dark = 0, light = 0;
        for (int y = 140; y < 200; ++y)
            for (int x = 0; x < 160; ++x) {
                const std::uint8_t* p = picture.at(x, y);
                dark += p[0] + p[1] + p[2] == 0;
                light += p[0] == 255 && p[1] == 255 && p[2] == 255;
            }
        EXPECT_GT(dark, 500) << view;
        EXPECT_GT(light, 100) << view;
        Scene part = scene;
        part.canvas.region = PixelRect{40, 10, 150, 120};
        EXPECT_EQ(view_of(part, view, "rc").width, 150) << view;
    }
}

}  // namespace
}  // namespace penumbra::test
