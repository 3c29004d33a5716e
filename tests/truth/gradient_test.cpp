// SPDX-License-Identifier: MIT
// Emission that changes along a stroke, against closed forms and many short pieces.
#include <gtest/gtest.h>

#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

Shape stroke(const Geometry& geometry, std::vector<EmissionStop> stops) {
    Shape shape;
    shape.geometry = geometry;
    shape.gradient = std::move(stops);
    return shape;
}

Line line(Point from, Point to, double width) { return {from, to, width}; }

const std::vector<Point> kEyes = {{50, 50}, {20.3, 44.1}, {80, 90}, {3, 30.2}, {97, 31}, {40, 33}};

TEST(Gradient, TwoThatAddUpToAConstant) {
    Polyline bent;
    bent.points = {{20, 30}, {60, 35}, {75, 60}, {75, 60}, {70, 20}};
    bent.width = 4;
    for (const bool closed : {false, true}) {
        bent.closed = closed;
        Scene up = empty_scene(), down = up, even = up;
        up.shapes = {stroke(bent, {{0, Colour(0)}, {0.3, Colour(1)}, {0.3, Colour(0.25)}, {1, Colour(1)}})};
        down.shapes = {stroke(bent, {{0, Colour(1)}, {0.3, Colour(0)}, {0.3, Colour(0.75)}, {1, Colour(0)}})};
        add(even, bent, Colour(1));
        for (const Point p : kEyes) EXPECT_NEAR(phi(up, p) + phi(down, p), phi(even, p), 1e-9) << closed << " " << p.x;
    }
}

TEST(Gradient, FromTheMiddleItIsItsMean) {
    Scene scene = empty_scene(), even = scene;
    scene.shapes = {stroke(line({20, 30}, {80, 30}, 3), {{0, Colour(0)}, {1, Colour(2)}})};
    add(even, line({20, 30}, {80, 30}, 3), Colour(1));
    for (const double y : {32.0, 40.0, 90.0}) EXPECT_NEAR(phi(scene, {50, y}), phi(even, {50, y}), 1e-10);
    // Seen along the line: its last round end alone.
    Scene end = empty_scene();
    add(end, disc({80, 30}, 1.5), Colour(2));
    EXPECT_NEAR(phi(scene, {95, 30}), phi(end, {95, 30}), 1e-10);
}

TEST(Gradient, IsTheLimitOfShortPieces) {
    Scene scene = empty_scene();
    scene.shapes = {stroke(line({20, 30}, {80, 30}, 3), {{0.1, Colour(0.5)}, {0.6, Colour(3)}, {1, Colour(1)}})};
    const auto emission = [](double s) { return s < 0.1 ? 0.5 : s < 0.6 ? 0.5 + 2.5 * (s - 0.1) / 0.5 : 3 - 2 * (s - 0.6) / 0.4; };
    Scene pieces = empty_scene();
    const int count = 400;
    add(pieces, disc({20, 30}, 1.5), Colour(0.5));
    add(pieces, disc({80, 30}, 1.5), Colour(1));
    for (int i = 0; i < count; ++i) {
        const double s = (i + 0.5) / count;
        add(pieces, box({20 + 60 * s, 30}, {60.0 / count, 3}), Colour(emission(s)));
    }
    for (const Point p : kEyes) EXPECT_NEAR(phi(scene, p), phi(pieces, p), 2e-5 * phi(pieces, p)) << p.x;
    // On a floor with relief, which asks for its moments too.
    for (Scene* one : {&scene, &pieces}) {
        auto normals = std::make_shared<Texels>();
        normals->width = normals->height = 1;
        normals->rgba = {160, 90, 220, 255};
        one->canvas.floor.normals = normals;
    }
    for (const Point p : kEyes) {
        const double right = reference::ExactSolver(pieces).value(p).r;
        EXPECT_NEAR(reference::ExactSolver(scene).value(p).r, right, 3e-5 * right + 1e-7) << p.x;
    }
}

TEST(Gradient, LightsSurfaces) {
    Scene scene = empty_scene();
    scene.shapes = {stroke(line({20, 30}, {80, 30}, 3), {{0, Colour(0)}, {1, Colour(2)}})};
    add(scene, box({60, 80}, {50, 6}), Colour(0), Colour(0.8));
    Scene other = scene, even = scene;
    other.shapes[0].gradient = {{0, Colour(2)}, {1, Colour(0)}};
    even.shapes[0].gradient.clear();
    even.shapes[0].emission = Colour(2);
    for (Scene* one : {&scene, &other, &even}) one->render.bounces = 1;
    for (const Point p : kEyes) EXPECT_NEAR(phi(scene, p) + phi(other, p), phi(even, p), 1e-4 * phi(even, p)) << p.x;
    EXPECT_GT(phi(scene, {85, 70}), phi(other, {85, 70}));
    // The stroke itself reflects too.
    for (Scene* one : {&scene, &other, &even}) {
        one->shapes[0].albedo = Colour(0.5);
        one->render.bounces = 2;
    }
    for (const Point p : kEyes) EXPECT_NEAR(phi(scene, p) + phi(other, p), phi(even, p), 1e-4 * phi(even, p)) << p.x;
}

}  // namespace
}  // namespace penumbra::truth
