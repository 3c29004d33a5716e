// SPDX-License-Identifier: MIT
// Emitters, occluders and the sky against closed forms.
#include <gtest/gtest.h>

#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

constexpr double kExact = 1e-12;

TEST(Direct, NothingIsBlack) { EXPECT_EQ(phi(empty_scene(), {50, 50}), 0); }

TEST(Direct, DiscFromOutside) {
    for (const double radius : {0.01, 1.0, 20.0}) {
        Scene scene = empty_scene();
        add(scene, disc({40, 45}, radius), Colour(3, 2, 1));
        for (const Point p : {Point(80.5, 60.5), Point(1.5, 2.5), Point(40, 99.5), Point(62, 45)}) {
            const double expected = std::asin(radius / distance(p, {40, 45})) / kPi;
            const Colour found = reference::mean_radiance_at(scene, p);
            EXPECT_NEAR(found.r, 3 * expected, kExact);
            EXPECT_NEAR(found.g, 2 * expected, kExact);
            EXPECT_NEAR(found.b, expected, kExact);
        }
    }
}

TEST(Direct, DiscCloseAtHand) {
    Scene scene = empty_scene();
    add(scene, disc({50, 50}, 10), Colour(1));
    const double gap = 1e-7;
    EXPECT_NEAR(phi(scene, {50, 60 + gap}), std::asin(10 / (10 + gap)) / kPi, 1e-9);
}

TEST(Direct, ThinRectangleSpansTheAngleOfItsCorners) {
    Scene scene = empty_scene();
    add(scene, box({50, 50}, {60, 1e-6}), Colour(1));
    EXPECT_NEAR(phi(scene, {50, 20}), 2 * std::atan(30 / (30 - 5e-7)) / (2 * kPi), kExact);
    // Edge on: all that shows is its end.
    EXPECT_NEAR(phi(scene, {90, 50}), 2 * std::atan(5e-7 / 10) / (2 * kPi), 1e-13);
}

TEST(Direct, SquareFromItsVertices) {
    for (const double rotation : {0.0, 17.0, 45.0, 90.0, -133.0}) {
        Scene scene = empty_scene();
        add(scene, box({50, 50}, {20, 12}, rotation), Colour(1));
        const double r = rotation * kPi / 180;
        const Point x(std::cos(r), std::sin(r)), y(-x.y, x.x);
        const Point c(50, 50);
        const std::vector<Point> corners{c + x * 10. + y * 6., c + x * 10. - y * 6.,
                                         c - x * 10. + y * 6., c - x * 10. - y * 6.};
        for (const Point p :
             {Point(20.5, 30.5), Point(50.5, 90.5), Point(85.5, 52.5), Point(66.5, 40.5)}) {
            EXPECT_NEAR(phi(scene, p), span_of(p, c, corners) / (2 * kPi), kExact) << rotation;
        }
    }
}

TEST(Direct, HalfPlane) {
    const double margin = 1e6;
    Scene scene = empty_scene(100, 100, margin);
    add(scene, box({50, 60 + 5e6}, {1e7, 1e7}), Colour(2));
    const double left = 50 + margin, right = 50 + margin;
    const double expected = (std::atan(left / 30) + std::atan(right / 30)) / (2 * kPi);
    EXPECT_NEAR(phi(scene, {50, 30}), 2 * expected, 1e-11);
    EXPECT_NEAR(phi(scene, {50, 30}), 1, 1e-4);
}

TEST(Direct, EllipseByItsTangents) {
    const double a = 25, b = 7;
    Scene scene = empty_scene();
    add(scene, Ellipse{{50, 50}, {a, b}, 0}, Colour(1));
    for (const Point p :
         {Point(50.5, 80.5), Point(90.5, 55.5), Point(10.5, 10.5), Point(78, 51), Point(52, 58)}) {
        // Pairs of tangents from (x, y): tan = 2 sqrt(b^2 x^2 + a^2 y^2 - a^2 b^2) / (x^2 + y^2 -
        // a^2 - b^2).
        const double x = p.x - 50, y = p.y - 50;
        const double rise = 2 * std::sqrt(b * b * x * x + a * a * y * y - a * a * b * b);
        const double angle = std::atan2(rise, x * x + y * y - a * a - b * b);
        EXPECT_NEAR(phi(scene, p), angle / (2 * kPi), kExact);
    }
}

TEST(Direct, DiscBehindDisc) {
    const Point p(10, 50);
    const double lamp = std::asin(10.0 / 70);  // half angle of the lamp, straight ahead
    for (const double shift : {0.0, 3.0, 6.0, -8.0, 12.0, 30.0}) {
        Scene scene = empty_scene();
        add(scene, disc({80, 50}, 10), Colour(1));
        const Point c(40, 50 + shift);
        add(scene, disc(c, 3));
        const double middle = std::atan2(shift, 30), half = std::asin(3 / std::hypot(30, shift));
        const double hidden =
            std::max(0.0, std::min(lamp, middle + half) - std::max(-lamp, middle - half));
        EXPECT_NEAR(phi(scene, p), (2 * lamp - hidden) / (2 * kPi), kExact) << shift;
    }
    Scene scene = empty_scene();
    add(scene, disc({80, 50}, 10), Colour(1));
    add(scene, disc({40, 50}, 5));  // asin(5 / 30) > asin(10 / 70)
    EXPECT_EQ(phi(scene, p), 0);
}

TEST(Direct, AnOccluderBehindTheLampHidesNothing) {
    Scene scene = empty_scene();
    add(scene, disc({40, 50}, 3), Colour(1));
    add(scene, disc({60, 50}, 16));
    EXPECT_NEAR(phi(scene, {10, 50}), std::asin(3.0 / 30) / kPi, kExact);
}

TEST(Direct, OverlappingLampsShareTheirUnion) {
    // Seen from the line of symmetry each shows its own half, in either order.
    for (const bool swapped : {false, true}) {
        Scene scene = empty_scene();
        add(scene, disc({swapped ? 56.0 : 44.0, 50}, 10),
            swapped ? Colour(0, 1, 0) : Colour(1, 0, 0));
        add(scene, disc({swapped ? 44.0 : 56.0, 50}, 10),
            swapped ? Colour(1, 0, 0) : Colour(0, 1, 0));
        const Point p(50, 10);
        const double reach = std::atan2(6, 40) + std::asin(10 / std::hypot(6, 40));
        const Colour found = reference::mean_radiance_at(scene, p);
        EXPECT_NEAR(found.r, reach / (2 * kPi), kExact);
        EXPECT_NEAR(found.g, reach / (2 * kPi), kExact);
    }
}

TEST(Direct, WhereOutlinesCoincideTheLaterCounts) {
    Scene scene = empty_scene();
    add(scene, disc({50, 50}, 10), Colour(1));
    add(scene, disc({50, 50}, 10), Colour(5));
    EXPECT_NEAR(phi(scene, {50, 80}), 5 * std::asin(10.0 / 30) / kPi, kExact);

    Scene sides = empty_scene();
    add(sides, box({50, 50}, {40, 20}), Colour(1));
    add(sides, box({60, 45}, {20, 10}), Colour(3));  // shares part of two sides
    const Point p(50, 10);
    const double all = 2 * std::atan(20.0 / 30), right = std::atan(20.0 / 30);
    EXPECT_NEAR(phi(sides, p), ((all - right) + 3 * right) / (2 * kPi), kExact);
    std::swap(sides.shapes[0], sides.shapes[1]);
    EXPECT_NEAR(phi(sides, p), all / (2 * kPi), kExact);
}

TEST(Direct, WhatLiesInsideASolidIsNotSeen) {
    for (const bool lamp_on_top : {false, true}) {
        Scene scene = empty_scene();
        add(scene, disc({50, 50}, 4), Colour(1));
        add(scene, disc({50, 50}, 10));
        if (lamp_on_top) std::swap(scene.shapes[0], scene.shapes[1]);
        EXPECT_EQ(phi(scene, {50, 80}), 0);
    }
}

TEST(Direct, ShapesThatTouchLeaveNoGap) {
    Scene scene = empty_scene();
    scene.sky.radiance = Colour(1);
    // A ring of four walls that only touch, round the point.
    add(scene, box({50, 25}, {60, 10}));
    add(scene, box({50, 75}, {60, 10}));
    add(scene, box({25, 50}, {10, 40}));
    add(scene, box({75, 50}, {10, 40}));
    for (const Point p : {Point(50, 50), Point(31, 31), Point(60.3, 40.7)})
        EXPECT_EQ(phi(scene, p), 0);
}

TEST(Direct, SkyFillsWhatIsOpen) {
    Scene scene = empty_scene();
    scene.sky.radiance = Colour(0.5, 1, 2);
    EXPECT_NEAR(phi(scene, {50, 50}, 2), 2, kExact);
    add(scene, disc({50, 50}, 10), Colour(7));
    const double share = std::asin(10.0 / 30) / kPi;
    EXPECT_NEAR(phi(scene, {20, 50}, 0), 0.5 * (1 - share) + 7 * share, kExact);
}

TEST(Direct, SkyGradient) {
    Scene scene = empty_scene();
    scene.sky.gradient = {{30, Colour(1)}, {90, Colour(4)}, {200, Colour(0)}};
    const double mean = (0.5 * (1 + 4) * 60 + 0.5 * 4 * 110 + 0.5 * 1 * 190) / 360;
    EXPECT_NEAR(phi(scene, {50, 50}), mean, kExact);
    // A wall that fills the lower half of the circle as far as the domain goes (angles 0 to 180).
    const double margin = 1e7;
    Scene half = scene;
    half.canvas.margin = margin;
    add(half, box({50, 60 + 5e7}, {1e9, 1e8}));
    // 180 to 200: 4 (200 - a) / 110; then (a - 200) / 190 up to angle 360.
    const double open = (0.5 * (4.0 * 20 / 110) * 20 + 0.5 * (160.0 / 190) * 160) / 360;
    EXPECT_NEAR(phi(half, {50, 60 - 1e-2}), open, 1e-8);
}

TEST(Direct, SkyGradientWithSteps) {
    Scene scene = empty_scene();
    scene.sky.gradient = {{0, Colour(1)}, {90, Colour(1)}, {90, Colour(3)}, {360, Colour(3)}};
    EXPECT_NEAR(phi(scene, {50, 50}), 0.25 * 1 + 0.75 * 3, kExact);
    scene.sky.gradient = {{123, Colour(2)}};
    EXPECT_NEAR(phi(scene, {50, 50}), 2, kExact);
}

TEST(Direct, GradientThroughASlit) {
    Scene scene = empty_scene();
    scene.sky.gradient = {{0, Colour(0)},
                          {360, Colour(360)}};  // its own angle in degrees, a step at 0
    add(scene, box({50, 50}, {100, 20}));
    // Through the slit between two walls only angles 60 to 120 show.
    scene.shapes.clear();
    const Point p(50, 20);
    const double half = 30 * std::tan(kPi / 6);
    add(scene, Polygon{{{-500, 50}, {50 - half, 50}, {50 - half - 300, 350}, {-500, 350}}});
    add(scene, Polygon{{{600, 50}, {50 + half, 50}, {50 + half + 300, 350}, {600, 350}}});
    add(scene, box({50, -50}, {300, 100}));
    add(scene, box({-30, 20}, {60, 100}));
    add(scene, box({130, 20}, {60, 100}));
    EXPECT_NEAR(phi(scene, p), 90.0 * 60 / 360, 1e-10);
}

TEST(Direct, GeometryOutsideTheDomainDoesNothing) {
    Scene scene = empty_scene();
    add(scene, disc({120, 50}, 10), Colour(1));
    EXPECT_EQ(phi(scene, {50, 50}), 0);
    scene.canvas.margin = 40;
    EXPECT_NEAR(phi(scene, {50, 50}), std::asin(10.0 / 70) / kPi, kExact);
    // Now its middle lies beyond the border, nearer than the tangents reach: the chord shows.
    scene.canvas.margin = 12;
    EXPECT_NEAR(phi(scene, {50, 50}), 2 * std::atan2(6, 62) / (2 * kPi), kExact);
    // The border itself is inside.
    Scene wall = empty_scene();
    add(wall, box({105, 50}, {10, 60}), Colour(1));
    EXPECT_NEAR(phi(wall, {50, 50}), 2 * std::atan2(30, 50) / (2 * kPi), kExact);
    wall.canvas.view = ViewRect{0, 0, 99.999, 99.999};
    EXPECT_EQ(phi(wall, {50, 50}), 0);
}

TEST(Direct, AnOccluderBeyondTheBorderDoesNotHideTheSky) {
    Scene scene = empty_scene();
    scene.sky.radiance = Colour(1);
    add(scene, box({50, -20}, {1000, 30}));
    EXPECT_NEAR(phi(scene, {50, 50}), 1, kExact);
}

TEST(Direct, ViewScalesAndMoves) {
    Scene scene = empty_scene();
    scene.canvas.view = ViewRect{-1, -1, 2, 2};
    add(scene, disc({0.25, 0.125}, 0.125), Colour(1));
    EXPECT_NEAR(phi(scene, {-0.5, -0.5}), std::asin(0.125 / std::hypot(0.75, 0.625)) / kPi, kExact);
}

}  // namespace
}  // namespace penumbra::truth
