// SPDX-License-Identifier: MIT
// Translucent shapes against Beer and Lambert's law in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

constexpr double kQuadrature = 2e-7;  // relative: what docs/methods/media.md promises

Medium medium(Colour extinction, Colour emission = Colour(0)) { return {extinction, emission}; }

void fill(Scene& scene, const Geometry& geometry, Medium with) {
    Shape shape;
    shape.geometry = geometry;
    shape.medium = with;
    scene.shapes.push_back(shape);
}

// In the middle of a disc every way out is a radius.
TEST(Media, TheMiddleOfADiscUnderASky) {
    const Colour sigma(0.02, 0.1, 0.7), glow(0.3, 0, 2), sky(1, 2, 3);
    Scene scene = empty_scene();
    scene.sky.radiance = sky;
    fill(scene, disc({50, 50}, 20), medium(sigma, glow));
    const Colour found = reference::mean_radiance_at(scene, {50, 50});
    for (int c = 0; c < 3; ++c) {
        const double passes = std::exp(-20 * sigma[c]);
        EXPECT_NEAR(found[c], sky[c] * passes + glow[c] * (1 - passes) / sigma[c], kQuadrature * sky[c]) << c;
    }
    // Without extinction it gains in proportion to the way.
    scene.shapes[0].medium = medium(Colour(0), glow);
    EXPECT_NEAR(phi(scene, {50, 50}, 2), 3 + 2 * 20, 1e-5);
}

// Seen from outside: the chord of each direction, integrated here by Simpson's rule over the sine of the angle.
TEST(Media, ADiscFromOutside) {
    Scene scene = empty_scene();
    scene.sky.radiance = Colour(1);
    fill(scene, disc({60, 40}, 15), medium(Colour(0.05), Colour(0.2)));
    const Point p(20, 30);
    const double far = distance(p, {60, 40}), half = std::asin(15 / far);
    const int steps = 20000;
    double fog = 0;
    for (int i = 0; i <= steps; ++i) {
        // angle = half * sin(x): the chord is smooth in x.
        const double x = kPi * (double(i) / steps - 0.5), angle = half * std::sin(x);
        const double chord = 2 * std::sqrt(std::max(15.0 * 15.0 - std::pow(far * std::sin(angle), 2), 0.0));
        const double passes = std::exp(-0.05 * chord);
        const double weight = (i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2) * kPi / steps / 3;
        fog += weight * half * std::cos(x) * (passes + 0.2 * (1 - passes) / 0.05 - 1);
    }
    EXPECT_NEAR(phi(scene, p), 1 + fog / (2 * kPi), kQuadrature);
}

// A slab across the whole domain between the point and the sky above, cut off where rays leave by the sides.
TEST(Media, ASlabInFrontOfTheSky) {
    Scene scene = empty_scene();
    scene.sky.radiance = Colour(1, 2, 0.5);
    const Colour sigma(0.03, 0.2, 0);
    fill(scene, box({50, 30}, {400, 10}), medium(sigma));
    const Point p(50, 60);
    const Colour found = reference::mean_radiance_at(scene, p);
    for (int c = 0; c < 2; ++c) {
        // Upwards, from the vertical: enters at a height of 25, leaves at 35; the sides are 50 away.
        const double whole = std::atan2(50, 35), none = std::atan2(50, 25);
        const auto passes = [&](double angle) {
            const double length = angle < whole ? 10 / std::cos(angle) : 50 / std::sin(angle) - 25 / std::cos(angle);
            return std::exp(-sigma[c] * length);
        };
        double lost = 0;
        for (const auto& [low, high] : {std::pair(0.0, whole), std::pair(whole, none)}) {
            const int steps = 2000;
            for (int i = 0; i <= steps; ++i)
                lost += (i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2) * (high - low) / steps / 3 * (1 - passes(low + (high - low) * i / steps));
        }
        EXPECT_NEAR(found[c], scene.sky.radiance[c] * (1 - 2 * lost / (2 * kPi)), kQuadrature * 2) << c;
    }
    EXPECT_NEAR(found.b, 0.5, 1e-9) << "what is clear in a channel changes nothing there";
}

// A lamp behind coloured glass around the point: each ray to it crosses the whole ring.
TEST(Media, ALampThroughColouredGlass) {
    Scene scene = empty_scene();
    add(scene, disc({85, 50}, 6), Colour(4, 3, 2));
    fill(scene, disc({50, 50}, 20), medium({0.01, 0.1, 1}));
    fill(scene, disc({50, 50}, 16), medium(Colour(0)));  // on top: a hole in the glass
    const Colour found = reference::mean_radiance_at(scene, {50, 50});
    const double span = 2 * std::asin(6.0 / 35) / (2 * kPi);
    EXPECT_NEAR(found.r, 4 * span * std::exp(-0.04), 1e-7);
    EXPECT_NEAR(found.g, 3 * span * std::exp(-0.4), 1e-7);
    EXPECT_NEAR(found.b, 2 * span * std::exp(-4.0), 1e-7);
    // Under the glass, the inner disc does nothing.
    std::swap(scene.shapes[1], scene.shapes[2]);
    EXPECT_NEAR(phi(scene, {50, 50}, 1), 3 * span * std::exp(-2.0), 1e-7);
}

TEST(Media, NothingIsTakenInsideOpaqueShapes) {
    Scene scene = empty_scene();
    fill(scene, box({50, 50}, {300, 300}), medium(Colour(0.1)));
    // A lamp all around: the fog between counts, however much of it lies over the lamp.
    for (const double side : {-1.0, 1.0}) {
        add(scene, box({50 + 40 * side, 50}, {20, 100}), Colour(1));
        add(scene, box({50, 50 + 40 * side}, {60, 20}), Colour(1));
    }
    double expected = 0;  // a square of half width 30 seen from its middle
    const int steps = 4000;
    for (int i = 0; i <= steps; ++i) {
        const double angle = kPi / 4 * i / steps;
        expected += (i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2) / (3.0 * steps) * std::exp(-0.1 * 30 / std::cos(angle));
    }
    EXPECT_NEAR(phi(scene, {50, 50}), expected, 1e-8);
    EXPECT_TRUE(reference::ExactSolver(scene).is_solid({90, 50}));
    EXPECT_FALSE(reference::ExactSolver(scene).is_solid({50, 50})) << "fog is free space";
}

TEST(Media, LightsWithoutASize) {
    Scene scene = empty_scene();
    scene.lights = {PointLight{{80, 50}, Colour(5)}, DirectionalLight{90, Colour(2)}};
    fill(scene, disc({50, 50}, 10), medium({0.02, 0.2, 0}));
    reference::ExactSolver solver(scene);
    const Colour found = solver.delta_radiance({50, 50});
    for (int c = 0; c < 3; ++c) {
        const double passes = std::exp(-10 * Colour(0.02, 0.2, 0)[c]);
        EXPECT_NEAR(found[c], (5.0 / 30 + 2) * passes / (2 * kPi), 1e-9) << c;
    }
    EXPECT_EQ(solver.mean_radiance({50, 50}), Colour(0));
}

// Of every kind of shape: what does nothing changes nothing, what lets nothing through is the opaque shape.
TEST(Media, ClearAndOpaqueLimits) {
    const Geometry geometries[] = {disc({50, 50}, 12),        Ellipse{{50, 50}, {18, 7}, 25},      box({50, 50}, {24, 14}, 30),
                                   box({50, 50}, {24, 14}, 30, 5), Line{{40, 45}, {62, 55}, 8},        Polyline{{{38, 40}, {52, 58}, {64, 44}}, 6, false},
                                   Polygon{{{36, 60}, {50, 36}, {66, 58}, {50, 52}}}};
    for (const Geometry& geometry : geometries) {
        Scene open = empty_scene();
        open.sky.gradient = {{20, {1, 0, 0.5}}, {200, {0, 1, 2}}, {200, {1, 1, 1}}};
        add(open, disc({85, 60}, 4), Colour(6));
        Scene clear = open, thick = open, solid = open;
        fill(clear, geometry, medium(Colour(0)));
        fill(clear, disc({2, 2}, 1), medium(Colour(1)));  // another that does something, elsewhere
        fill(open, disc({2, 2}, 1), medium(Colour(1)));
        add(solid, geometry, Colour(3, 2, 1));
        fill(thick, geometry, medium(Colour(1e6), Colour(3e6, 2e6, 1e6)));
        for (const Point p : {Point(20.5, 30.5), Point(80.5, 35.5), Point(50.5, 85.5)}) {
            const Colour a = reference::mean_radiance_at(open, p), b = reference::mean_radiance_at(clear, p);
            const Colour c = reference::mean_radiance_at(solid, p), d = reference::mean_radiance_at(thick, p);
            for (int i = 0; i < 3; ++i) {
                EXPECT_NEAR(a[i], b[i], 1e-7) << geometry.index();
                EXPECT_NEAR(c[i], d[i], 2e-5) << geometry.index();
            }
        }
    }
}

// Many that overlap, before a sky with a step, against a march in small steps that asks each shape's own formula where it is.
TEST(Media, ManyThatOverlapAgainstAMarch) {
    Scene scene = empty_scene();
    scene.sky.gradient = {{20, {1, 0, 0.5}}, {200, {0, 1, 2}}, {200, {1, 1, 1}}};
    add(scene, disc({80, 70}, 9), Colour(3, 4, 5));
    const Medium media[] = {medium({0.02, 0.05, 0.1}, Colour(0.02)), medium({0.1, 0.01, 0.05}), medium(Colour(0.03), {0.1, 0, 0}), medium({0, 0.2, 0.1})};
    fill(scene, Ellipse{{40, 40}, {30, 12}, 90}, media[0]);
    fill(scene, box({60, 60}, {40, 20}, 0, 6), media[1]);
    fill(scene, Polygon{{{10, 10}, {70, 10}, {10, 90}}}, media[2]);
    fill(scene, Line{{20, 60}, {90, 60}, 10}, media[3]);
    const auto top = [](Point q) {
        if (std::hypot(q.x - std::clamp(q.x, 20.0, 90.0), q.y - 60) <= 5) return 3;
        if (q.x >= 10 && q.y >= 10 && (q.x - 10) / 60 + (q.y - 10) / 80 <= 1) return 2;
        if (std::hypot(std::max(std::abs(q.x - 60) - 14, 0.0), std::max(std::abs(q.y - 60) - 4, 0.0)) <= 6) return 1;
        if (std::pow((q.x - 40) / 12, 2) + std::pow((q.y - 40) / 30, 2) <= 1) return 0;
        return -1;
    };
    const auto sky = [](double degrees) {
        const Colour a(1, 0, 0.5), b(0, 1, 2), c(1, 1, 1);
        if (degrees >= 20 && degrees < 200) return a + (b - a) * ((degrees - 20) / 180);
        return c + (a - c) * ((degrees >= 200 ? degrees - 200 : degrees + 160) / 180);
    };
    constexpr double kStep = 0.02;
    constexpr int kRays = 3000;
    for (const Point p : {Point(45.5, 47.5), Point(12.5, 92.5), Point(70.5, 30.5)}) {
        Colour sum(0);
        for (int ray = 0; ray < kRays; ++ray) {
            const double angle = 2 * kPi * (ray + 0.5) / kRays;
            const Point d(std::cos(angle), std::sin(angle));
            Colour light(0), through(1);
            bool lamp = false;
            for (double t = 0.5 * kStep;; t += kStep) {
                const Point q = p + d * t;
                lamp = std::hypot(q.x - 80, q.y - 70) <= 9;
                if (lamp || q.x < 0 || q.y < 0 || q.x > 100 || q.y > 100) break;
                const int in = top(q);
                if (in < 0) continue;
                for (int c = 0; c < 3; ++c) {
                    light[c] += through[c] * media[in].emission[c] * kStep;
                    through[c] *= 1 - media[in].extinction[c] * kStep;
                }
            }
            sum += light + through * (lamp ? Colour(3, 4, 5) : sky(angle * 180 / kPi));
        }
        const Colour found = reference::mean_radiance_at(scene, p);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], sum[c] / kRays, 3e-3 * found[c]) << p.x << " " << c;
    }
}

TEST(Media, BouncesAreRefusedByName) {
    Scene scene = empty_scene();
    scene.render.bounces = 1;
    add(scene, disc({50, 50}, 6), Colour(1), Colour(0.5));
    fill(scene, disc({20, 20}, 6), medium(Colour(1)));
    const reference::Solution solution = reference::solve(scene);
    ASSERT_EQ(solution.problems.size(), 1u);
    EXPECT_EQ(solution.problems[0].pointer, "/render/bounces");
}

}  // namespace
}  // namespace penumbra::truth
