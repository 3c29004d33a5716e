// SPDX-License-Identifier: MIT
// The lists of near shapes: their order, their slices, and that their bounds hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/plan/pack.h"
#include "core/plan/shape_bounds.h"
#include "core/plan/shape_lists.h"
#include "glsl/distance.h"
#include "tests/support/build_scene.h"
#include "tests/support/sdf.h"

namespace penumbra::test {
namespace {

std::vector<int> list_at(const ShapeLists& lists, int x, int y, int slice = 0) {
    const glm::ivec2 tile(x / glsl::kDistanceTile, y / glsl::kDistanceTile);
    const std::size_t i = std::size_t(slice) * lists.tile_count() + std::size_t(tile.y) * std::size_t(lists.tiles.x) + std::size_t(tile.x);
    const glm::ivec2 range = lists.ranges.at(i);
    return {lists.shapes.begin() + range.x, lists.shapes.begin() + range.y};
}

ShapeLists lists_of(const Scene& scene, double reach_px = kUnlimitedReach) {
    return list_shapes(pack_scene(scene, 1), plan_grid(scene.canvas), 0, 0, reach_px);
}

TEST(ShapeLists, KeepWhatIsNearAndWhatCovers) {
    const ShapeLists lists = lists_of(with(canvas(256, 64), {shape(Rect{{32, 32}, {60, 60}, 0, 0}), shape(Circle{{32, 32}, 5}),
                                                             shape(Circle{{200, 32}, 5})}));
    EXPECT_EQ(lists.tiles, glm::ivec2((256 + glsl::kDistanceTile - 1) / glsl::kDistanceTile, (64 + glsl::kDistanceTile - 1) / glsl::kDistanceTile));
    EXPECT_EQ(list_at(lists, 32, 32), (std::vector<int>{0, 1}));  // the one below counts for the distance
    EXPECT_EQ(list_at(lists, 80, 32), (std::vector<int>{0}));
    EXPECT_EQ(list_at(lists, 200, 32), (std::vector<int>{2}));
    EXPECT_LT(lists.mean_length, 2);
}

TEST(ShapeLists, BitmapsWhereTheyAre) {
    Bitmap bitmap{picture(4, 4, [](int, int) { return true; }), {96, 96}, {32, 32}};
    const ShapeLists lists = lists_of(with(canvas(256, 256), {shape(Circle{{20, 20}, 5}), shape(bitmap)}));
    EXPECT_EQ(list_at(lists, 112, 112), (std::vector<int>{0, 1}));  // its distance comes later, by jump flooding
    EXPECT_EQ(list_at(lists, 200, 200), (std::vector<int>{0}));
}

TEST(ShapeLists, NothingNearIsNothingAsked) {
    // Beyond the diagonal no shape is nearer than none.
    EXPECT_EQ(list_at(lists_of(with(canvas(32, 32), {shape(Circle{{900, 20}, 5}), shape(Circle{{-900, 20}, 5})})), 0, 0), std::vector<int>());
}

TEST(ShapeLists, NothingBeyondTheReachIsAsked) {
    const Scene scene = with(canvas(256, 256), {shape(Circle{{100, 100}, 40}), shape(Rect{{212, 20}, {8, 8}, 0, 0})});
    const ShapeLists lists = lists_of(scene, 6);
    EXPECT_EQ(list_at(lists, 100, 20), std::vector<int>());    // 40 px off
    EXPECT_EQ(list_at(lists, 100, 50), (std::vector<int>{0}));  // 10 px off at the pixel, 4 px in its tile
    EXPECT_EQ(list_at(lists, 100, 100), (std::vector<int>{0}));
    EXPECT_EQ(list_at(lists, 212, 20), (std::vector<int>{1}));
    EXPECT_EQ(list_at(lists, 250, 250), std::vector<int>());
    EXPECT_LT(lists.mean_length, 0.2);
    EXPECT_GT(lists_of(scene).mean_length, 1);
    const SkippedWork saved = saved_by_lists(lists, pack_scene(scene, 1), plan_grid(scene.canvas), 6);
    EXPECT_NE(saved.why.find("within 6 px"), std::string::npos) << saved.why;
    EXPECT_EQ(list_at(lists_of(with(canvas(64, 64), {shape(Circle{{32, 32}, 5})}), 6), 32, 32), (std::vector<int>{0})) << "one shape alone";
}

TEST(ShapeLists, WhatLiesDeepUnderAnotherIsNotAskedWithinAReach) {
    const Shape wide = shape(Circle{{64, 64}, 60}), small = shape(Circle{{64, 64}, 10});
    EXPECT_EQ(list_at(lists_of(with(canvas(128, 128), {small, wide}), 6), 64, 64), (std::vector<int>{1}));
    EXPECT_EQ(list_at(lists_of(with(canvas(128, 128), {small, wide})), 64, 64), (std::vector<int>{0, 1}));
    // On top it shows.
    EXPECT_EQ(list_at(lists_of(with(canvas(128, 128), {wide, small}), 6), 68, 68), (std::vector<int>{0, 1}));
    // Near the edge of what covers, what is below counts.
    EXPECT_EQ(list_at(lists_of(with(canvas(128, 128), {shape(Circle{{116, 64}, 8}), wide}), 6), 121, 64), (std::vector<int>{0, 1}));
}

TEST(ShapeLists, LongListsAreSliced) {
    Polyline scribble{{}, 0.2, false};
    Numbers numbers(1);
    for (int i = 0; i < 9001; ++i) scribble.points.push_back({numbers.between(0, 16), numbers.between(0, 16)});
    Scene scene = canvas(16, 16);
    for (int i = 0; i < 7; ++i) scene.shapes.push_back(shape(scribble));
    const ShapeLists lists = lists_of(scene);
    EXPECT_EQ(lists.slices, 3);
    EXPECT_EQ(list_at(lists, 3, 3, 0), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(list_at(lists, 3, 3, 1), (std::vector<int>{3, 4, 5}));
    EXPECT_EQ(list_at(lists, 3, 3, 2), (std::vector<int>{6}));
    EXPECT_EQ(lists.mean_length, 7);
    const SkippedWork saved = saved_by_lists(lists, pack_scene(scene, 1), plan_grid(scene.canvas));
    EXPECT_EQ(saved.saved, 0);
    EXPECT_NE(saved.why.find("7.0 on average"), std::string::npos) << saved.why;
}

TEST(ShapeBounds, HoldTheExactDistance) {
    Numbers numbers(2);
    const auto near = [&] { return Point(numbers.between(-80, 80), numbers.between(-80, 80)); };
    for (int i = 0; i < 4000; ++i) {
        const double size = std::pow(10, numbers.between(-1, 2));
        const Geometry geometries[] = {
            Circle{near(), size}, Ellipse{near(), {size, size * std::pow(10, numbers.between(-2, 1))}, numbers.between(0, 360)},
            Rect{near(), {size, 9}, numbers.between(0, 360), std::min(size, 9.0) * numbers.between(0, 0.5)},
            Line{near(), near(), size}, Polyline{{near(), near(), near()}, size, true}, Polygon{{near(), near(), near(), near(), near()}}};
        const Scene scene = with(canvas(64, 64), {shape(geometries[i % 6])});
        const Point p = near();
        const double reach = numbers.between(0, 12);
        const DistanceBounds bounds = distance_bounds(pack_scene(scene, 1), 0, p, reach, 1e9);
        double widest = 0;
        for (int k = 0; k < 12; ++k) {
            const double angle = numbers.between(0, 2 * std::numbers::pi);
            const Point q = p + numbers.next() * reach * Point(std::cos(angle), std::sin(angle));
            const double d = exact_distance(scene.shapes[0], q);
            ASSERT_LE(bounds.low, d) << "shape " << i;
            ASSERT_GE(bounds.high, d) << "shape " << i;
            widest = std::max(widest, std::abs(d));
        }
        // And are worth something: of an ellipse the shader loses some digits, and so must they.
        double loose = 0.1;
        if (const auto* e = std::get_if<Ellipse>(&geometries[i % 6])) loose += 0.01 * (widest + 3 * std::max(e->radii.x, e->radii.y) + reach);
        EXPECT_LE(bounds.high - bounds.low, 4 * reach + loose) << "shape " << i;
    }
}

}  // namespace
}  // namespace penumbra::test
