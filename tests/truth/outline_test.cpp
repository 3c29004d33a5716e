// SPDX-License-Identifier: MIT
// Shapes whose outline has many pieces: rounded rectangles, capsules, polygons, bitmaps.
#include <gtest/gtest.h>

#include <memory>

#include "core/reference/intersect.h"
#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

constexpr double kExact = 1e-12;

// The angle spanned by discs whose hull is convex and seen from outside.
double span_of_discs(Point p, Point towards, const std::vector<Point>& centers, double radius) {
    double low = 0, high = 0;
    bool first = true;
    for (const Point& c : centers) {
        const double middle = std::remainder(angle_to(p, c) - angle_to(p, towards), 2 * kPi);
        const double half = std::asin(radius / distance(p, c));
        low = first ? middle - half : std::min(low, middle - half);
        high = first ? middle + half : std::max(high, middle + half);
        first = false;
    }
    return high - low;
}

TEST(Outlines, RoundedRectangle) {
    for (const double corner : {1.0, 4.0, 10.0}) {
        Scene scene = empty_scene();
        add(scene, box({50, 50}, {40, 20}, 30, corner), Colour(1));
        const double r = kPi / 6;
        const Point x(std::cos(r), std::sin(r)), y(-x.y, x.x), c(50, 50);
        const double u = 20 - corner, v = 10 - corner;
        const std::vector<Point> centers{c + x * u + y * v, c + x * u - y * v, c - x * u + y * v,
                                         c - x * u - y * v};
        for (const Point p :
             {Point(5.5, 5.5), Point(50.5, 90.5), Point(95.5, 50.5), Point(20.5, 60.5)}) {
            EXPECT_NEAR(phi(scene, p), span_of_discs(p, c, centers, corner) / (2 * kPi), kExact)
                << corner;
        }
    }
}

TEST(Outlines, RoundedToADisc) {
    Scene scene = empty_scene();
    add(scene, box({50, 50}, {20, 20}, 12, 10), Colour(1));
    EXPECT_NEAR(phi(scene, {80, 90}), std::asin(10.0 / 50) / kPi, kExact);
    reference::ExactSolver solver(scene);
    EXPECT_TRUE(solver.is_solid({50, 59.9}));
    EXPECT_FALSE(solver.is_solid({58, 58}));
}

TEST(Outlines, LineIsACapsule) {
    Scene scene = empty_scene();
    add(scene, Line{{30, 40}, {70, 65}, 6}, Colour(1));
    for (const Point p : {Point(50, 90), Point(10, 10), Point(90, 80), Point(20, 50)}) {
        EXPECT_NEAR(phi(scene, p),
                    span_of_discs(p, {50, 52.5}, {{30, 40}, {70, 65}}, 3) / (2 * kPi), kExact);
    }
    Scene point = empty_scene();
    add(point, Line{{30, 40}, {30, 40}, 6}, Colour(1));
    EXPECT_NEAR(phi(point, {60, 80}), std::asin(3.0 / 50) / kPi, kExact);
}

TEST(Outlines, PolylineIsOneSolid) {
    const std::vector<Point> points{{30, 40}, {45, 60}, {70, 45}, {72, 44}};
    Scene scene = empty_scene();
    add(scene, Polyline{points, 5, false}, Colour(1));
    for (const Point p : {Point(50, 95), Point(5, 50), Point(95, 20)}) {
        EXPECT_NEAR(phi(scene, p), span_of_discs(p, {50, 50}, points, 2.5) / (2 * kPi), 1e-9);
    }
    // A closed one with a point inside is a furnace.
    Scene ring = empty_scene();
    add(ring, Polyline{{{20, 20}, {80, 30}, {70, 80}, {25, 70}}, 3, true}, Colour(2));
    ring.sky.radiance = Colour(100);
    EXPECT_NEAR(phi(ring, {50, 50}), 2, 1e-7);
    std::get<Polyline>(ring.shapes[0].geometry).closed = false;
    EXPECT_GT(phi(ring, {50, 50}), 3);
}

TEST(Outlines, PolygonWithAHole) {
    // An outer and an inner square joined by a seam that is passed twice.
    Polygon ring{{{20, 20},
                  {80, 20},
                  {80, 80},
                  {20, 80},
                  {20, 20},
                  {40, 40},
                  {40, 60},
                  {60, 60},
                  {60, 40},
                  {40, 40}}};
    Scene scene = empty_scene();
    add(scene, ring, Colour(3));
    EXPECT_NEAR(phi(scene, {50, 50}), 3, kExact);
    EXPECT_NEAR(phi(scene, {41, 59}), 3, kExact);
    EXPECT_NEAR(phi(scene, {50, 95}), 3 * 2 * std::atan(30.0 / 15) / (2 * kPi), kExact);
    EXPECT_TRUE(reference::ExactSolver(scene).is_solid({30, 50}));
    EXPECT_FALSE(reference::ExactSolver(scene).is_solid({50, 50}));
}

TEST(Outlines, PolygonOfSeveralRings) {
    // The same without the seam, and a square apart.
    const Polygon rings{{{20, 20}, {80, 20}, {80, 80}, {20, 80}, {40, 40}, {40, 60}, {60, 60}, {60, 40}, {85, 20}, {95, 20}, {95, 30}, {85, 30}}, {4, 8}};
    Scene scene = empty_scene();
    add(scene, rings, Colour(3));
    EXPECT_NEAR(phi(scene, {50, 50}), 3, kExact);
    EXPECT_NEAR(phi(scene, {50, 95}), phi(scene, {50, 95.000001}), 1e-6);
    EXPECT_NEAR(phi(scene, {5, 50}), 3 * 2 * std::atan(30.0 / 15) / (2 * kPi), kExact);
    const reference::ExactSolver solver(scene);
    EXPECT_TRUE(solver.is_solid({30, 50}));
    EXPECT_FALSE(solver.is_solid({50, 50}));
    EXPECT_TRUE(solver.is_solid({90, 25}));
    EXPECT_FALSE(solver.is_solid({82, 25}));
}

TEST(Outlines, PolygonThatCrossesItself) {
    Polygon star;
    for (int i = 0; i < 5; ++i) {
        const double a = (0.3 + 2.0 * i / 5 * 2) * kPi;
        star.points.push_back({50 + 30 * std::cos(a), 50 + 30 * std::sin(a)});
    }
    Scene scene = empty_scene();
    add(scene, star, Colour(1));
    scene.sky.radiance = Colour(9);
    // Even-odd leaves the middle open, and closed all round.
    EXPECT_NEAR(phi(scene, {50, 50}), 1, kExact);
    EXPECT_NEAR(phi(scene, {53, 48}), 1, kExact);
    scene.sky.radiance = Colour(0);
    EXPECT_NEAR(phi(scene, {2, 50}), span_of({2, 50}, {50, 50}, star.points) / (2 * kPi), kExact);

    // A bow tie, seen along its axis: two triangles that meet in a point.
    Scene tie = empty_scene();
    add(tie, Polygon{{{40, 30}, {60, 70}, {40, 70}, {60, 30}}}, Colour(1));
    EXPECT_NEAR(phi(tie, {50, 90}), 2 * std::atan(10.0 / 20) / (2 * kPi), kExact);
    EXPECT_NEAR(phi(tie, {80, 50}), span_of({80, 50}, {50, 50}, {{60, 30}, {60, 70}}) / (2 * kPi),
                kExact);
}

std::shared_ptr<Texels> picture(int width, int height,
                                const std::vector<std::array<int, 4>>& texels) {
    auto made = std::make_shared<Texels>();
    made->width = width;
    made->height = height;
    for (const auto& t : texels) {
        for (const int v : t) made->rgba.push_back(std::uint8_t(v));
    }
    return made;
}

TEST(Outlines, BitmapOfOneColourIsARectangle) {
    const std::vector<std::array<int, 4>> white(12, {255, 255, 255, 255});
    Scene scene = empty_scene(), twin = empty_scene();
    add(scene, Bitmap{picture(4, 3, white), {30, 40}, {20, 12}, 2.0, 0.5, false});
    add(twin, box({40, 46}, {20, 12}), Colour(2));
    for (const Point p : {Point(10.3, 10.3), Point(40.1, 80.7), Point(95.5, 44.5)}) {
        EXPECT_NEAR(phi(scene, p), phi(twin, p), kExact);
    }
}

TEST(Outlines, BitmapTexelsHaveTheirOwnColours) {
    // Red left, green right, above a texel that alpha leaves open and one that just counts.
    Scene scene = empty_scene();
    add(scene,
        Bitmap{
            picture(2, 2, {{255, 0, 0, 255}, {0, 188, 0, 255}, {9, 9, 9, 127}, {0, 0, 255, 128}}),
            {40, 40},
            {20, 20},
            3.0,
            0.5,
            false});
    const Point p(50, 10);
    const Colour found = reference::mean_radiance_at(scene, p);
    EXPECT_NEAR(found.r, 3 * std::atan(10.0 / 30) / (2 * kPi), kExact);
    const double green = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);  // sRGB
    EXPECT_NEAR(found.g, 3 * green * std::atan(10.0 / 30) / (2 * kPi), kExact);
    EXPECT_EQ(found.b, 0);
    reference::ExactSolver solver(scene);
    EXPECT_FALSE(solver.is_solid({45, 55}));
    EXPECT_TRUE(solver.is_solid({55, 55}));
    // From the open texel: red above, blue to the right.
    const Colour inside = solver.mean_radiance({45, 55});
    EXPECT_NEAR(inside.r, 3 * 0.25, kExact);
    EXPECT_NEAR(inside.b, 3 * 0.25, kExact);
}

TEST(Outlines, TexelsThatTouchAtACornerLetNoLightThrough) {
    Scene scene = empty_scene();
    add(scene, Bitmap{picture(2, 2, {{0, 0, 0, 255}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 255}}),
                      {40, 40},
                      {20, 20}});
    add(scene, disc({70, 30}, 4), Colour(1));
    EXPECT_NEAR(phi(scene, {45, 55}), 0, 1e-15);
}

TEST(Outlines, ATooLargeOutlineIsRefused) {
    Scene scene = empty_scene();
    for (int i = 0; i < 20; ++i) add(scene, box({5.0 * i, 50}, {2, 2}));
    reference::SolveOptions options;
    options.max_pieces = 40;
    const auto solution = reference::solve(scene, options);
    ASSERT_EQ(solution.problems.size(), 1u);
    EXPECT_EQ(solution.problems[0].code, "too_many_pieces");
    EXPECT_TRUE(solution.image.data.empty());
}

TEST(Outlines, TrigPolynomialFindsClosePairsOfRoots) {
    // cos t - 1 + e has roots at +- acos(1 - e).
    reference::TrigPolynomial f;
    f.c1 = 1;
    f.c0 = -1 + 1e-8;
    const auto roots = f.roots();
    ASSERT_EQ(roots.size(), 2u);
    EXPECT_NEAR(roots[0], std::acos(1 - 1e-8), 1e-10);
    EXPECT_NEAR(2 * kPi - roots[1], std::acos(1 - 1e-8), 1e-10);
    reference::TrigPolynomial four;
    four.c2 = 1;
    EXPECT_EQ(four.roots().size(), 4u);
}

}  // namespace
}  // namespace penumbra::truth
