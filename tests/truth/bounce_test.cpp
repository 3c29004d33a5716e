// SPDX-License-Identifier: MIT
// Reflected light against closed forms.
#include <gtest/gtest.h>

#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

// Walls round the point (50, 50), all of one material.
Scene box_of_walls(Colour emission, Colour albedo) {
    Scene scene = empty_scene();
    add(scene, box({50, 20}, {80, 10}), emission, albedo);
    add(scene, box({50, 80}, {80, 10}), emission, albedo);
    add(scene, box({20, 50}, {10, 80}), emission, albedo);
    add(scene, box({80, 50}, {10, 80}), emission, albedo);
    return scene;
}

Scene ring_of_polygon(Colour emission, Colour albedo) {
    Scene scene = empty_scene();
    add(scene,
        Polygon{{{10, 10},
                 {90, 15},
                 {85, 90},
                 {12, 80},
                 {10, 10},
                 {30, 25},
                 {20, 70},
                 {50, 55},
                 {75, 75},
                 {80, 20},
                 {30, 25}}},
        emission, albedo);
    return scene;
}

TEST(Bounces, FurnaceAfterEachBounce) {
    const Colour emission(1, 2, 0.5), albedo(0.5, 0.9, 1);
    for (const bool ring : {false, true}) {
        for (const int bounces : {0, 1, 2, 5, 20}) {
            Scene scene = ring ? ring_of_polygon(emission, albedo) : box_of_walls(emission, albedo);
            scene.render.bounces = bounces;
            reference::SolveOptions options;
            options.element_length_px = 2;
            reference::ExactSolver solver(scene, options);
            for (const Point p : {Point(50.3, 49.1), Point(33.3, 52.7)}) {
                const Colour found = solver.mean_radiance(p);
                for (int c = 0; c < 3; ++c) {
                    const double rho = albedo[c];
                    const double sum =
                        rho == 1 ? bounces + 1 : (1 - std::pow(rho, bounces + 1)) / (1 - rho);
                    EXPECT_NEAR(found[c], emission[c] * sum, 1e-9 * emission[c] * sum)
                        << bounces << " " << c << " " << ring;
                }
            }
        }
    }
}

TEST(Bounces, ClosedFurnaceConverges) {
    Scene scene = box_of_walls(Colour(1), Colour(0.5));
    scene.render.bounces = 64;
    reference::SolveOptions options;
    options.element_length_px = 4;
    EXPECT_NEAR(reference::ExactSolver(scene, options).mean_radiance({47, 53})[0], 1 / (1 - 0.5),
                1e-9);
}

TEST(Bounces, RoundFurnace) {
    // The inside of a closed stroke: its walls are arcs and straight pieces, joined smoothly.
    Scene scene = empty_scene();
    add(scene, Polyline{{{20, 20}, {80, 30}, {70, 80}, {25, 70}}, 8, true}, Colour(1), Colour(0.8));
    add(scene, disc({50, 55}, 7), Colour(1), Colour(0.8));
    add(scene, Ellipse{{40, 40}, {6, 2}, 20}, Colour(1), Colour(0.8));
    scene.render.bounces = 3;
    const double expected = (1 - std::pow(0.8, 4)) / (1 - 0.8);
    EXPECT_NEAR(phi(scene, {60, 45}), expected, 1e-7);
}

TEST(Bounces, AConvexBodyUnderAnEvenSky) {
    const double rho = 0.6;
    for (const int bounces : {1, 3}) {
        Scene scene = empty_scene();
        scene.sky.radiance = Colour(2);
        add(scene, Ellipse{{50, 50}, {20, 8}, 25}, Colour(0), Colour(rho));
        scene.render.bounces = bounces;
        const double bare = phi(
            [&] {
                Scene s = scene;
                s.render.bounces = 0;
                return s;
            }(),
            {50.5, 80.5});
        const double open = bare / 2;
        EXPECT_NEAR(phi(scene, {50.5, 80.5}), 2 * open + 2 * rho * (1 - open), 1e-10);
    }
}

TEST(Bounces, ACosineSkyOverALevelFloor) {
    // A linear gradient about the zenith (270 degrees): irradiance in closed form,
    // integral of (a + b t) cos t over +-pi/2 = 2 a for any slope b.
    Scene scene = empty_scene(100, 100, 400);
    scene.sky.gradient = {{180, Colour(1)}, {360, Colour(3)}};
    add(scene, box({50, 150}, {900, 180}), Colour(0), Colour(0.5));
    scene.render.bounces = 1;
    Scene direct = scene;
    direct.render.bounces = 0;
    const Point p(50, 50);
    const double floor = (std::atan(450.0 / 10) * 2) / (2 * kPi);
    EXPECT_NEAR(phi(scene, p) - phi(direct, p), 0.5 * 2 * floor, 1e-9);
}

TEST(Bounces, ALampAboveAFloor) {
    // A point light at height h over an endless floor: Lo = rho / 2 I h / (h^2 + x^2), and at
    // height y above its foot the mean radiance is rho I / (4 (h + y)).
    Scene scene = empty_scene(100, 100, 1500);
    const double rho = 0.7, intensity = 40;
    add(scene, box({50, 1000}, {5000, 1840}), Colour(0), Colour(rho));
    scene.lights.push_back(PointLight{{50, 60}, Colour(intensity)});
    scene.render.bounces = 1;
    for (const double y : {0.5, 5.0, 30.0}) {
        const double expected = rho * intensity / (4 * (20 + y));
        EXPECT_NEAR(phi(scene, {50, 80 - y}), expected, 2e-5 * expected) << y;
    }
}

TEST(Bounces, FinerElementsChangeLittle) {
    Scene scene = box_of_walls(Colour(0), Colour(0.8, 0.4, 0.2));
    add(scene, disc({40, 45}, 3), Colour(5));
    add(scene, box({60, 55}, {12, 6}, 20), Colour(0), Colour(0.5));
    scene.render.bounces = 4;
    const auto solve_at = [&](double length) {
        reference::SolveOptions options;
        options.element_length_px = length;
        options.stride = 3;
        return reference::solve(scene, options).image;
    };
    const ImageF coarse = solve_at(0.5), fine = solve_at(0.125);
    double largest = 0, sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < fine.data.size(); ++i) {
        if (std::isnan(fine.data[i])) continue;
        sum += fine.data[i];
        ++count;
        largest = std::max(largest, std::abs(double(fine.data[i]) - coarse.data[i]));
    }
    EXPECT_LT(largest, 2e-4 * sum / count);
}

}  // namespace
}  // namespace penumbra::truth
