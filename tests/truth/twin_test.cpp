// SPDX-License-Identifier: MIT
// The solver against its Monte Carlo twin, on scenes of all shape types with overlaps.
#include <gtest/gtest.h>

#include "core/reference/boundary.h"
#include "core/reference/sweep.h"
#include "tests/truth/scenes.h"
#include "tests/truth/twin.h"

namespace penumbra::truth {
namespace {

Point random_direction(std::mt19937_64& random) {
    const double a = std::uniform_real_distribution<double>(0, 2 * kPi)(random);
    return {std::cos(a), std::sin(a)};
}

Point random_free_point(const Scene& scene, const Twin& twin, std::mt19937_64& random) {
    const double width = scene.canvas.width, height = scene.canvas.height;
    for (int i = 0; i < 10000; ++i) {
        const Point p(std::uniform_real_distribution<double>(0, width)(random),
                      std::uniform_real_distribution<double>(0, height)(random));
        if (!twin.is_solid(p)) return p;
    }
    return {-1, -1};
}

TEST(Twin, SolidPointsAgree) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        const Scene scene = random_scene(seed, 14);
        const Twin twin(scene);
        reference::ExactSolver solver(scene);
        std::mt19937_64 random(seed);
        for (int i = 0; i < 2000; ++i) {
            const Point p(std::uniform_real_distribution<double>(0, 100)(random),
                          std::uniform_real_distribution<double>(0, 80)(random));
            ASSERT_EQ(solver.is_solid(p), twin.is_solid(p)) << seed << ": " << p.x << ", " << p.y;
        }
    }
}

// No noise at all: every random ray must meet what the sweep's interval says.
TEST(Twin, EveryRayMeetsWhatTheSweepSays) {
    std::uint64_t rays = 0;
    for (unsigned seed = 1; seed <= 120; ++seed) {
        const Scene scene = random_scene(seed, 7 + int(seed % 22));
        const Twin twin(scene);
        const reference::Boundary boundary(scene, 100000, seed % 2 == 0);
        reference::Sweep sweep(boundary);
        std::mt19937_64 random(seed);
        for (int k = 0; k < 25; ++k) {
            const Point p = random_free_point(scene, twin, random);
            if (p.x < 0) break;
            const Point forward = random_direction(random);
            const auto& seen = sweep.look(p, forward, 0, false);
            double whole = 0;
            for (const auto& interval : seen) whole += reference::angle_of(interval);
            ASSERT_NEAR(whole, 2 * kPi, 1e-12);
            for (int i = 0; i < 80; ++i) {
                const Point d = random_direction(random);
                const double key = reference::direction_key(forward, d);
                const auto* found = &seen.back();
                for (const auto& interval : seen) {
                    if (key >= interval.key_from && key <= interval.key_to) found = &interval;
                }
                if (std::min(key - found->key_from, found->key_to - key) < 1e-8) continue;
                const TwinHit hit = twin.hit(p, d);
                ASSERT_EQ(hit.is_sky, found->piece < 0) << "seed " << seed << " at " << p.x << ", "
                                                        << p.y << " towards " << d.x << ", " << d.y;
                ++rays;
                if (hit.is_sky) continue;
                const auto& piece = boundary.pieces()[std::size_t(found->piece)];
                const auto& material = boundary.material_of(piece);
                ASSERT_NEAR(reference::distance_to(piece, p, d), hit.distance,
                            1e-7 * (1 + hit.distance))
                    << seed;
                for (int c = 0; c < 3; ++c) {
                    ASSERT_NEAR(material.emission[c], hit.emission[c], 1e-12) << seed;
                    ASSERT_NEAR(material.albedo[c], hit.albedo[c], 1e-12) << seed;
                }
            }
        }
    }
    EXPECT_GT(rays, 200000u);
}

// z-scores of the twin's mean against the solver, collected over points and channels.
struct Scores {
    int count = 0, beyond_three = 0;
    double largest = 0, squares = 0;

    void add(double expected, double sum, double sum_squares, int n) {
        const double mean = sum / n;
        const double variance = std::max(sum_squares / n - mean * mean, 0.0) / (n - 1);
        if (variance < 1e-24) {
            EXPECT_NEAR(mean, expected, 1e-9);
            return;
        }
        const double z = std::abs(mean - expected) / std::sqrt(variance);
        ++count;
        squares += z * z;
        largest = std::max(largest, z);
        if (z > 3) ++beyond_three;
    }
    // One score in 370 lies beyond three standard errors by chance.
    void judge() const {
        EXPECT_LE(beyond_three, 1 + count / 150);
        EXPECT_LT(largest, 4.5);
        EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2.0 / count) + 0.05);
    }
};

void compare(const Scene& scene, unsigned seed, int points, int samples, double element_length,
             Scores& scores) {
    const Twin twin(scene);
    reference::SolveOptions options;
    options.element_length_px = element_length;
    reference::ExactSolver solver(scene, options);
    std::mt19937_64 random(seed * 77);
    for (int k = 0; k < points; ++k) {
        const Point p = random_free_point(scene, twin, random);
        if (p.x < 0) return;
        const Colour expected = solver.mean_radiance(p);
        Colour sum(0), squares(0);
        for (int i = 0; i < samples; ++i) {
            const Colour c = twin.path(p, random_direction(random), scene.render.bounces, random);
            sum += c;
            squares += c * c;
        }
        for (int c = 0; c < 3; ++c) scores.add(expected[c], sum[c], squares[c], samples);
    }
}

TEST(Twin, DirectLightWithinStandardErrors) {
    Scores scores;
    for (unsigned seed = 1; seed <= 30; ++seed)
        compare(random_scene(seed, 10), seed, 3, 20000, 1, scores);
    scores.judge();
}

TEST(Twin, BouncesWithinStandardErrors) {
    Scores scores;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        Scene scene = random_scene(seed, 9);
        scene.render.bounces = 1 + int(seed % 3);
        compare(scene, seed, 3, 20000, 1, scores);
    }
    scores.judge();
}

TEST(Twin, DeltaLightsOnSurfacesWithinStandardErrors) {
    Scores scores;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        Scene scene = random_scene(seed, 9);
        for (Shape& shape : scene.shapes) shape.emission = Colour(0);
        scene.sky = Sky{};
        scene.lights.push_back(DirectionalLight{40.0 * seed, Colour(1, 2, 3)});
        std::mt19937_64 random(seed);
        scene.lights.push_back(
            PointLight{random_free_point(scene, Twin(scene), random), Colour(30, 20, 10)});
        scene.render.bounces = 2;
        compare(scene, seed, 3, 10000, 1, scores);
    }
    scores.judge();
}

}  // namespace
}  // namespace penumbra::truth
