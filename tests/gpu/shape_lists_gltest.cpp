// SPDX-License-Identifier: MIT
// The lists of near shapes change no bit of the distance field: scenes of every kind of shape, with and without them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/plan/pack.h"
#include "core/plan/shape_lists.h"
#include "tests/gpu/shared_context.h"
#include "tests/support/build_scene.h"

namespace penumbra::test {
namespace {

// Returns how many shapes a pixel asks.
double expect_same_with_lists(const Scene& scene, const std::string& what, const PassSettings& settings = {}) {
    Plan plan = pass_plan(scene);
    EXPECT_TRUE(plan.list_shapes) << what;
    const Field listed = run_distance(scene, plan, settings);
    plan.list_shapes = false;
    const Field all = run_distance(scene, plan);
    EXPECT_EQ(listed.distance, all.distance) << what;
    EXPECT_EQ(listed.material, all.material) << what;
    return list_shapes(pack_scene(scene, 1), plan.grid).mean_length;
}

// A shape of any kind, somewhere in or near a canvas of this size; `size` is about its extent.
Shape any_shape(Numbers& numbers, double width, double height, double size) {
    const auto around = [&](double about) { return about * std::pow(10, numbers.between(-1, 0.3)); };
    const Point at{numbers.between(-0.2, 1.2) * width, numbers.between(-0.2, 1.2) * height};
    const auto near = [&] { return at + Point(numbers.between(-1, 1), numbers.between(-1, 1)) * around(size); };
    switch (int(numbers.between(0, 7))) {
        case 0: return shape(Circle{at, around(size)});
        case 1: return shape(Ellipse{at, {around(size), around(size) * std::pow(10, numbers.between(-2, 0))}, numbers.between(0, 360)});
        case 2: {
            const glm::dvec2 sides{around(size), around(size)};
            return shape(Rect{at, sides, numbers.between(0, 360), numbers.between(0, 0.5) * std::min(sides.x, sides.y)});
        }
        case 3: return shape(Line{at, near(), around(size / 5)});
        case 4: return shape(Polyline{{at, near(), near(), near()}, around(size / 5), numbers.next() < 0.5});
        case 5: return shape(Polygon{{at, near(), near(), near(), near()}});
        default: {
            const int side = int(numbers.between(1, 12));
            return shape(Bitmap{picture(side, side, [&](int, int) { return numbers.next() < 0.6; }), at, {around(size), around(size)}});
        }
    }
}

Scene any_scene(std::uint64_t seed, int width, int height, int count, double size) {
    Numbers numbers(seed);
    Scene scene = canvas(width, height);
    for (int i = 0; i < count; ++i) {
        scene.shapes.push_back(any_shape(numbers, width, height, size));
        // Now and then the same again, which is a tie everywhere.
        if (numbers.next() < 0.05) scene.shapes.push_back(scene.shapes.back());
    }
    return scene;
}

TEST(ShapeLists, ChangeNoBitOfTheField) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const std::string what = "scene " + std::to_string(seed);
        const double asked = expect_same_with_lists(any_scene(seed, 150, 117, 300, 6), "small shapes, " + what);
        EXPECT_LT(asked, 60) << "the lists leave too much in";
        expect_same_with_lists(any_scene(100 + seed, 150, 117, 40, 25), "large shapes, " + what);
        expect_same_with_lists(any_scene(200 + seed, 61, 170, 120, 1), "tiny shapes, " + what);
        expect_same_with_lists(any_scene(300 + seed, 70, 70, 30, 400), "shapes larger than the view, " + what);
        expect_same_with_lists(any_scene(400 + seed, 33, 9, 2 + int(seed) % 5, 8), "few shapes, " + what);
    }
}

TEST(ShapeLists, NorWithMarginAndViewFarOff) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        Scene scene = any_scene(500 + seed, 120, 90, 150, 6);
        scene.canvas.margin = 30.4;
        expect_same_with_lists(scene, "margin, scene " + std::to_string(seed));
        scene.canvas.margin = 0;
        scene.canvas.view = ViewRect{40, 30, 12, 9};
        expect_same_with_lists(scene, "ten times as large, scene " + std::to_string(seed));
        scene.canvas.view = ViewRect{-4000, -3000, 8000, 6000};
        expect_same_with_lists(scene, "far away, scene " + std::to_string(seed));
    }
}

TEST(ShapeLists, NorForNeedlesAndNests) {
    Numbers numbers(11);
    Scene needles = canvas(90, 70);
    for (int i = 0; i < 80; ++i)
        needles.shapes.push_back(shape(Ellipse{{numbers.between(0, 90), numbers.between(0, 70)},
                                               {numbers.between(1, 60), std::pow(10, numbers.between(-4, 0))},
                                               numbers.between(0, 360)}));
    expect_same_with_lists(needles, "needles");
    Scene nest = canvas(90, 70);
    for (int i = 40; i > 0; --i) nest.shapes.push_back(shape(Circle{{44.5, 35.5}, double(i)}));
    for (int i = 1; i < 20; ++i) nest.shapes.push_back(shape(Rect{{44.5, 35.5}, {double(i), double(i)}, 0, 0}));
    expect_same_with_lists(nest, "rings in rings, the smallest on top, then squares, the largest on top");
}

TEST(ShapeLists, NorInSlicesAndBands) {
    // More edges than one invocation may walk, all over the view.
    Numbers numbers(13);
    Scene scene = canvas(43, 26);
    for (int i = 0; i < 16; ++i) {
        Polyline scribble{{}, 0.2, i % 2 == 0};
        for (int k = 0; k < 2500; ++k) scribble.points.push_back({numbers.between(0, 43), numbers.between(0, 26)});
        scene.shapes.push_back(shape(scribble));
    }
    const Plan plan = pass_plan(scene);
    EXPECT_GT(list_shapes(pack_scene(scene, 1), plan.grid).slices, 1);
    expect_same_with_lists(scene, "slices");
    expect_same_with_lists(any_scene(1, 150, 117, 100, 6), "bands", PassSettings{150 * 8, 0, 0, nullptr});
}

// Up to the reach the same field, beyond it no nearer.
void expect_same_within_reach(const Scene& scene, const std::string& what) {
    constexpr float reach = 6;
    Plan plan = pass_plan(scene);
    plan.list_shapes = false;
    plan.jump_steps.clear();  // a window finds exactly what flooding may miss: its own test
    const Field all = run_distance(scene, plan);
    plan.list_shapes = true;
    plan.distance_reach_px = reach;
    const Field near = run_distance(scene, plan);
    std::size_t far = 0;
    for (std::size_t i = 0; i < all.distance.size(); ++i) {
        const float d = all.distance[i];
        if (std::abs(d) < reach) {
            ASSERT_EQ(near.distance[i], d) << what << ", pixel " << i;
        } else if (d > 0) {
            ASSERT_GE(near.distance[i], std::min(reach, float(plan.grid.diagonal_px))) << what << ", pixel " << i;
            ++far;
        } else {
            ASSERT_LE(near.distance[i], -reach) << what << ", pixel " << i;
        }
        if (d < reach) {
            ASSERT_EQ(near.material[i], all.material[i]) << what << ", pixel " << i;
        }
    }
    if (far == all.distance.size()) {
        EXPECT_EQ(near.material, std::vector<int>(near.material.size(), -1)) << what;
    }
}

TEST(ShapeLists, WithinAReachTheFieldIsTheSame) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const std::string what = "scene " + std::to_string(seed);
        expect_same_within_reach(any_scene(seed, 150, 117, 60, 6), "small shapes, " + what);
        expect_same_within_reach(any_scene(100 + seed, 150, 117, 10, 25), "large shapes, " + what);
        expect_same_within_reach(any_scene(300 + seed, 70, 70, 30, 400), "shapes larger than the view, " + what);
        expect_same_within_reach(any_scene(400 + seed, 201, 133, 1 + int(seed) % 5, 8), "few shapes, " + what);
        Scene margin = any_scene(500 + seed, 120, 90, 20, 6);
        margin.canvas.margin = 30.4;
        expect_same_within_reach(margin, "margin, " + what);
    }
    expect_same_within_reach(with(canvas(64, 64), {shape(Circle{{900, 20}, 5})}), "nothing near");
    expect_same_within_reach(with(canvas(3, 2), {shape(Circle{{9, 1}, 5})}), "a canvas smaller than the reach");
}

}  // namespace
}  // namespace penumbra::test
