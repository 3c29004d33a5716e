// SPDX-License-Identifier: MIT
// Regions that outlines close off from all light.
#include "core/plan/closed.h"

#include <gtest/gtest.h>

#include "core/plan/pack.h"
#include "tests/support/build_scene.h"

namespace penumbra {
namespace {

using test::canvas;
using test::shape;

std::vector<DarkRegion> regions_of(const Scene& scene) {
    const reference::Boundary boundary(scene, 1'000'000, false);
    return dark_regions(boundary, PixelFrame(scene.canvas));
}

Scene room(std::vector<Shape> more = {}, Colour emission = Colour(0)) {
    Scene scene = canvas(128, 128);
    scene.shapes = {shape(Polyline{{{10, 10}, {100, 10}, {100, 90}, {10, 90}}, 3, true}, emission)};
    for (Shape& s : more) scene.shapes.push_back(s);
    return scene;
}

TEST(DarkRegions, ARoomWithoutALampIsOne) {
    const auto regions = regions_of(room());
    ASSERT_EQ(regions.size(), 1u);
    // Inside of the walls: from 11.5 to 98.5 and from 11.5 to 88.5, less two pixels.
    const auto tiles = tiles_within(regions, {128, 128}, 16);
    ASSERT_EQ(tiles.size(), 5u * 4u);
    EXPECT_EQ(tiles.front(), glm::ivec2(16, 16));
    EXPECT_EQ(tiles.back(), glm::ivec2(80, 64));
}

TEST(DarkRegions, AnythingThatShinesInsideLightsIt) {
    EXPECT_TRUE(regions_of(room({shape(Circle{{50, 50}, 2}, Colour(1))})).empty());
    EXPECT_TRUE(regions_of(room({}, Colour(1))).empty()) << "its walls";
    EXPECT_EQ(regions_of(room({shape(Circle{{115, 50}, 2}, Colour(1))})).size(), 1u) << "outside";
    EXPECT_EQ(regions_of(room({shape(Circle{{50, 50}, 2})})).size(), 1u) << "a pillar";
}

TEST(DarkRegions, AnOpenDoorLetsLightIn) {
    Scene scene = canvas(128, 128);
    scene.shapes = {shape(Polyline{{{10, 10}, {100, 10}, {100, 90}, {10, 90}, {10, 14}}, 3, false})};
    EXPECT_TRUE(regions_of(scene).empty());
}

TEST(DarkRegions, WhatTheDomainCutsOpenIsOpen) {
    Scene scene = room();
    scene.canvas.view = ViewRect{20, 0, 128, 128};
    EXPECT_TRUE(regions_of(scene).empty());
    scene.canvas.margin = 20;
    EXPECT_EQ(regions_of(scene).size(), 1u);
}

TEST(DarkRegions, RoundAndManyWallsCloseAsWell) {
    Scene scene = canvas(128, 128);
    scene.shapes = {shape(Rect{{60, 20}, {90, 5}, 0, 0}), shape(Rect{{60, 100}, {90, 5}, 0, 0}), shape(Rect{{20, 60}, {5, 90}, 0, 0}),
                    shape(Ellipse{{100, 60}, {6, 60}, 3})};
    EXPECT_EQ(regions_of(scene).size(), 1u);
}

TEST(DarkRegions, ALitRoomInADarkOneLightsOnlyItself) {
    const Shape inner = shape(Polyline{{{40, 40}, {70, 40}, {70, 70}, {40, 70}}, 2, true});
    EXPECT_EQ(regions_of(room({inner})).size(), 2u);
    // The lamp is in both rings: the outer one is not told dark, which it is.
    EXPECT_EQ(regions_of(room({inner, shape(Circle{{55, 55}, 2}, Colour(1))})).size(), 0u);
}

}  // namespace
}  // namespace penumbra
