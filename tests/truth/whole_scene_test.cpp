// SPDX-License-Identifier: MIT
// Pictures: turned and moved scenes, what pixels hold, stride, region, threads, cancelling.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/truth/scenes.h"
#include "tests/truth/twin.h"

namespace penumbra::truth {
namespace {

// Moves every point by x -> rotate(x - about) + about + shift. Bitmaps stay upright: left out of
// turns.
struct Motion {
    double degrees = 0;
    Point about{50, 50};
    Point shift{0};

    Point operator()(Point p) const {
        const double r = degrees * kPi / 180;
        const Point d = p - about;
        return about + shift +
               Point(d.x * std::cos(r) - d.y * std::sin(r), d.x * std::sin(r) + d.y * std::cos(r));
    }
    Geometry moved(Circle g) const {
        g.center = (*this)(g.center);
        return g;
    }
    Geometry moved(Ellipse g) const {
        g.center = (*this)(g.center);
        g.rotation_deg += degrees;
        return g;
    }
    Geometry moved(Rect g) const {
        g.center = (*this)(g.center);
        g.rotation_deg += degrees;
        return g;
    }
    Geometry moved(Line g) const {
        g.from = (*this)(g.from);
        g.to = (*this)(g.to);
        return g;
    }
    Geometry moved(Polyline g) const {
        for (Point& p : g.points) p = (*this)(p);
        return g;
    }
    Geometry moved(Polygon g) const {
        for (Point& p : g.points) p = (*this)(p);
        return g;
    }
    Geometry moved(Bitmap g) const {
        g.position += shift;
        return g;
    }

    Scene operator()(const Scene& scene) const {
        Scene made = scene;
        for (Shape& shape : made.shapes)
            shape.geometry = std::visit([&](const auto& g) { return moved(g); }, shape.geometry);
        for (Light& light : made.lights) {
            if (auto* p = std::get_if<PointLight>(&light))
                p->position = (*this)(p->position);
            else if (auto* s = std::get_if<SpotLight>(&light)) {
                s->position = (*this)(s->position);
                s->direction_deg += degrees;
            } else
                std::get<DirectionalLight>(light).direction_deg += degrees;
        }
        std::vector<SkyStop> stops;
        for (SkyStop stop : made.sky.gradient) {
            stop.angle_deg = stop.angle_deg + degrees;
            stop.angle_deg -= 360 * std::floor(stop.angle_deg / 360);
            stops.push_back(stop);
        }
        // Back in order, which steps (equal angles) must keep.
        std::stable_sort(stops.begin(), stops.end(), [](const SkyStop& a, const SkyStop& b) {
            return a.angle_deg < b.angle_deg;
        });
        made.sky.gradient = stops;
        return made;
    }
};

// Everything within 45 of the middle, so that the square domain cuts nothing at any turn.
Scene compact_scene(int bounces) {
    Scene scene = empty_scene();
    scene.sky.gradient = {{20, Colour(0.5, 0.1, 0)},
                          {100, Colour(1)},
                          {100, Colour(0.2)},
                          {260, Colour(0, 0.4, 0.8)}};
    add(scene, disc({40, 35}, 9), Colour(2, 1, 0), Colour(0.5));
    add(scene, Ellipse{{64, 40}, {12, 4}, 33}, Colour(0), Colour(0.9, 0.5, 0.1));
    add(scene, box({50, 60}, {30, 8}, 12, 3), Colour(0, 0.2, 0.4), Colour(0.3));
    add(scene, Polyline{{{25, 45}, {30, 65}, {45, 75}, {60, 70}}, 3, false}, Colour(0),
        Colour(0.7));
    add(scene, Polygon{{{60, 50}, {80, 62}, {58, 66}, {78, 50}}}, Colour(1, 0, 2), Colour(0.2));
    add(scene, Line{{35, 30}, {60, 22}, 2}, Colour(0.5), Colour(0.4));
    scene.lights = {PointLight{{52, 48}, Colour(10)}, SpotLight{{30, 40}, 20, 10, 40, Colour(9)},
                    DirectionalLight{70, Colour(1)}};
    scene.render.bounces = bounces;
    return scene;
}

void expect_same(const Scene& scene, const Motion& motion, double tolerance) {
    const Scene other = motion(scene);
    reference::SolveOptions options;
    options.element_length_px = 1;
    reference::ExactSolver a(scene, options), b(other, options);
    int compared = 0;
    for (double y = 6.37; y < 100; y += 9.11) {
        for (double x = 5.91; x < 100; x += 8.77) {
            const Point p(x, y);
            if (distance(p, {50, 50}) > 48) continue;
            ASSERT_EQ(a.is_solid(p), b.is_solid(motion(p)));
            if (a.is_solid(p)) continue;
            const Colour u = a.value(p), v = b.value(motion(p));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(u[c], v[c], tolerance) << x << ", " << y;
            ++compared;
        }
    }
    EXPECT_GT(compared, 30);
}

TEST(WholeScene, TurnedSceneTurnedLight) {
    for (const double degrees : {90.0, 180.0, 37.0, -123.456, 1e-3})
        expect_same(compact_scene(0), {degrees}, 1e-9);
}

// Rings are cut into elements from the same side whatever the turn: equal to the elements'
// accuracy.
TEST(WholeScene, TurnedSceneTurnedLightWithBounces) { expect_same(compact_scene(2), {61}, 3e-5); }

TEST(WholeScene, MovedSceneMovedLight) {
    for (const Point shift : {Point(1000.25, -300.5), Point(1e5, 1e5)}) {
        Scene scene = random_scene(8, 14);
        Motion motion{0, {0, 0}, shift};
        Scene moved = motion(scene);
        moved.canvas.view = ViewRect{shift.x, shift.y, 100, 80};
        reference::ExactSolver a(scene), b(moved);
        for (double y = 3.3; y < 80; y += 7.7) {
            for (double x = 2.2; x < 100; x += 7.9) {
                if (a.is_solid({x, y})) continue;
                const Colour u = a.value({x, y}), v = b.value(Point(x, y) + shift);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(u[c], v[c], 1e-8);
            }
        }
    }
}

TEST(WholeScene, DoubledEmissionDoubledLight) {
    Scene scene = compact_scene(1);
    scene.sky = Sky{};
    scene.lights.clear();
    Scene doubled = scene;
    for (Shape& shape : doubled.shapes) shape.emission *= 2;
    reference::ExactSolver a(scene), b(doubled);
    for (const Point p : {Point(20.5, 20.5), Point(55.5, 50.5), Point(90.5, 10.5)}) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(b.value(p)[c], 2 * a.value(p)[c], 1e-12);
    }
}

TEST(Picture, PixelsHoldTheValueAtTheirCentres) {
    Scene scene = compact_scene(0);
    scene.canvas.floor_albedo = Colour(0.5, 1, 0.25);
    const auto solution = reference::solve(scene);
    ASSERT_EQ(solution.image.width, 100);
    ASSERT_EQ(solution.image.channels, 3);
    reference::ExactSolver solver(scene);
    int solid = 0;
    for (int y = 0; y < 100; y += 3) {
        for (int x = 0; x < 100; x += 3) {
            const Point p(x + 0.5, y + 0.5);
            const float* pixel = solution.image.at(x, y);
            if (solver.is_solid(p)) {
                EXPECT_TRUE(std::isnan(pixel[0]) && std::isnan(pixel[2]));
                ++solid;
            } else {
                for (int c = 0; c < 3; ++c) EXPECT_EQ(pixel[c], float(solver.value(p)[c]));
            }
        }
    }
    EXPECT_GT(solid, 20);
    EXPECT_GT(solution.intervals, 50000u);
    EXPECT_GT(solution.seconds, 0);
}

TEST(Picture, StrideAndRegionLeaveTheRestOut) {
    const Scene scene = compact_scene(0);
    const auto whole = reference::solve(scene);
    reference::SolveOptions options;
    options.stride = 4;
    options.threads = 1;
    options.region = reference::Region{10, 20, 70, 100};
    const auto part = reference::solve(scene, options);
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x) {
            const bool chosen = x % 4 == 2 && y % 4 == 2 && x >= 10 && x < 70 && y >= 20;
            const float a = *whole.image.at(x, y), b = *part.image.at(x, y);
            if (chosen && !std::isnan(a))
                EXPECT_EQ(a, b);
            else
                EXPECT_TRUE(std::isnan(b));
        }
    }
}

TEST(Picture, ReportsProgressAndCanBeCancelled) {
    Scene scene = compact_scene(0);
    scene.canvas.width = scene.canvas.height = 400;
    scene.canvas.view = ViewRect{0, 0, 100, 100};
    reference::SolveOptions options;
    double last = -1;
    int calls = 0;
    options.progress = [&](double fraction) {
        EXPECT_GE(fraction, last);
        EXPECT_LE(fraction, 1);
        last = fraction;
        return ++calls < 3;
    };
    const auto solution = reference::solve(scene, options);
    EXPECT_TRUE(solution.cancelled || calls < 3);
    scene.render.bounces = 30;
    options.element_length_px = 0.1;
    options.progress = [](double) { return false; };
    EXPECT_TRUE(reference::solve(scene, options).cancelled);
}

TEST(Picture, ABlackSceneIsBlack) {
    Scene scene = empty_scene(20, 20);
    add(scene, disc({10, 10}, 4), Colour(0), Colour(0.5));
    scene.render.bounces = 3;
    const auto solution = reference::solve(scene);
    EXPECT_EQ(*solution.image.at(1, 1), 0);
    EXPECT_TRUE(std::isnan(*solution.image.at(10, 10)));
}

}  // namespace
}  // namespace penumbra::truth
