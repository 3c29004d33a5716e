// SPDX-License-Identifier: MIT
// Which shapes are left out, where the light is constant, which cascades are too far: arithmetic without a device.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/plan/plan.h"
#include "core/plan/saving.h"
#include "core/plan/skip.h"

namespace penumbra {
namespace {

Shape shape_of(Geometry geometry, double emission = 0) {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.emission = Colour(emission);
    return shape;
}

Scene scene_of(std::vector<Shape> shapes) {
    Scene scene;
    scene.canvas.width = 100;
    scene.canvas.height = 80;
    scene.shapes = std::move(shapes);
    return scene;
}

std::shared_ptr<const Texels> texels(int alpha, int colour) {
    auto image = std::make_shared<Texels>();
    image->width = image->height = 2;
    for (int i = 0; i < 4; ++i)
        for (const int v : {colour, colour, colour, alpha}) image->rgba.push_back(static_cast<std::uint8_t>(v));
    return image;
}

// How many shapes stay, and why the others went.
std::string kept(const Scene& scene) {
    std::vector<SkippedWork> skipped;
    const std::optional<Scene> lean = without_unseen_shapes(scene, skipped);
    std::string text = std::to_string(lean ? lean->shapes.size() : scene.shapes.size());
    for (const SkippedWork& work : skipped) text += "; " + std::to_string(int(work.saved)) + " " + work.why;
    return text;
}

TEST(UnseenShapes, OutsideTheDomain) {
    EXPECT_EQ(kept(scene_of({shape_of(Circle{{50, 40}, 5}), shape_of(Circle{{130, 40}, 5})})), "1; 1 they lie outside the domain");
    EXPECT_EQ(kept(scene_of({shape_of(Circle{{109, 40}, 5})})), "1") << "nearer than cells are judged by";
    EXPECT_EQ(kept(scene_of({shape_of(Circle{{130, 40}, 31})})), "1");
    Scene wide = scene_of({shape_of(Circle{{130, 40}, 5})});
    wide.canvas.margin = 20;
    EXPECT_EQ(kept(wide), "1") << "the margin counts";
    // The corner of its box is inside, the disc is not.
    EXPECT_EQ(kept(scene_of({shape_of(Circle{{130, 110}, 33})})), "0; 1 they lie outside the domain");
    EXPECT_EQ(kept(scene_of({shape_of(Line{{-300, 40}, {300, 40}, 1})})), "1");
    wide.render.keep = std::uint32_t(Saving::shapes);
    wide.canvas.margin = 0;
    EXPECT_EQ(kept(wide), "1");
    wide.render.keep = 0;
    wide.render.skip = Skip::none;
    EXPECT_EQ(kept(wide), "1");
}

TEST(UnseenShapes, UnderLaterOnes) {
    const Shape big = shape_of(Circle{{50, 40}, 20}, 1);
    const std::string covered = "1; 1 a later shape covers all of them";
    const std::vector<Geometry> small = {Circle{{52, 41}, 5},
                                         Ellipse{{50, 40}, {9, 3}, 30},
                                         Rect{{48, 40}, {8, 6}, 20, 1},
                                         Line{{45, 40}, {55, 44}, 2},
                                         Polyline{{{45, 40}, {55, 44}, {50, 50}}, 2, true},
                                         Polygon{{{45, 40}, {55, 44}, {50, 50}}},
                                         Bitmap{texels(255, 255), {45, 35}, {8, 8}}};
    for (const Geometry& g : small) {
        EXPECT_EQ(kept(scene_of({shape_of(g, 3), big})), covered) << g.index();
        EXPECT_EQ(kept(scene_of({big, shape_of(g, 3)})), "2") << "on top: " << g.index();
    }
    const std::vector<Geometry> large = {Ellipse{{50, 40}, {30, 20}, 10}, Rect{{50, 40}, {30, 30}, 33, 4}, Line{{40, 40}, {60, 41}, 26},
                                         Polyline{{{10, 40}, {70, 41}, {70, 60}}, 26, false},
                                         Polygon{{{25, 15}, {75, 18}, {70, 65}, {28, 62}}}};
    for (const Geometry& g : large) EXPECT_EQ(kept(scene_of({shape_of(Circle{{50, 40}, 5}), shape_of(g)})), covered) << g.index();
    EXPECT_EQ(kept(scene_of({shape_of(Circle{{50, 40}, 5}), shape_of(Bitmap{texels(255, 0), {0, 0}, {100, 80}})})), "2") << "a bitmap may have holes";
}

TEST(UnseenShapes, AreKeptWhereTheyShow) {
    const Shape small = shape_of(Circle{{50, 40}, 5});
    for (const Geometry& g : std::vector<Geometry>{Circle{{54, 40}, 8.9}, Rect{{50, 40}, {9.9, 30}, 0, 0}, Rect{{50, 40}, {10, 10}, 0, 0},
                                                   Ellipse{{50, 40}, {30, 5}, 0}, Line{{20, 40}, {80, 40}, 9.9},
                                                   // A hole in the middle, by the even-odd rule.
                                                   Polygon{{{20, 10}, {80, 10}, {80, 70}, {20, 70}, {20, 10}, {44, 34}, {56, 34}, {56, 46}, {44, 46}, {44, 34}}}})
        EXPECT_EQ(kept(scene_of({small, shape_of(g)})), "2") << g.index();
    // Covered by two together, by neither alone.
    EXPECT_EQ(kept(scene_of({small, shape_of(Rect{{45, 40}, {10.5, 40}, 0, 0}), shape_of(Rect{{55, 40}, {10.5, 40}, 0, 0})})), "3");
}

TEST(UnseenShapes, WithoutASolidTexel) {
    EXPECT_EQ(kept(scene_of({shape_of(Bitmap{texels(100, 255), {20, 20}, {30, 30}})})), "0; 1 no texel of them is solid");
    EXPECT_EQ(kept(scene_of({shape_of(Bitmap{texels(128, 255), {20, 20}, {30, 30}})})), "1");
}

TEST(ConstantLight, WhereNothingShinesOrOnlyTheSky) {
    EXPECT_EQ(constant_light(scene_of({shape_of(Circle{{50, 40}, 5})}))->mean_radiance, Colour(0));
    EXPECT_FALSE(constant_light(scene_of({shape_of(Circle{{50, 40}, 5}, 1e-6)})));
    EXPECT_TRUE(constant_light(scene_of({shape_of(Circle{{-50, 40}, 5}, 3)}))) << "a lamp outside the domain";
    EXPECT_TRUE(constant_light(scene_of({shape_of(Bitmap{texels(255, 0), {20, 20}, {30, 30}})}))) << "black texels";
    EXPECT_FALSE(constant_light(scene_of({shape_of(Bitmap{texels(255, 1), {20, 20}, {30, 30}})})));
    Scene sky = scene_of({});
    sky.sky.radiance = Colour(1, 2, 3);
    EXPECT_EQ(constant_light(sky)->mean_radiance, Colour(1, 2, 3));
    sky.shapes = {shape_of(Circle{{-50, 40}, 49})};
    EXPECT_TRUE(constant_light(sky));
    sky.shapes = {shape_of(Circle{{-50, 40}, 50})};
    EXPECT_FALSE(constant_light(sky)) << "it touches the border";
    sky.shapes.clear();
    sky.sky.gradient = {{0, Colour(0)}, {180, Colour(4)}};
    EXPECT_NEAR(constant_light(sky)->mean_radiance.x, 2, 1e-12);
    sky.lights.push_back(PointLight{{-500, 0}, Colour(1)});
    EXPECT_FALSE(constant_light(sky)) << "a light may stand outside";
    sky.lights = {DirectionalLight{90, Colour(0)}};
    EXPECT_TRUE(constant_light(sky)) << "a light without light";
    sky.render.keep = std::uint32_t(Saving::constant);
    EXPECT_FALSE(constant_light(sky));
}

TEST(FarCascades, EndWhereNothingMatters) {
    const auto cascades = [](const Extent& matters) {
        std::vector<CascadePlan> list = plan_cascades({512, 512}, 725, cascade_settings(Quality::standard));
        const std::size_t all = list.size();
        const std::size_t left_out = leave_out_far(list, matters, 725);
        EXPECT_EQ(left_out, all - list.size());
        EXPECT_GE(list.back().end, 725);
        return list;
    };
    const std::size_t all = plan_cascades({512, 512}, 725, cascade_settings(Quality::standard)).size();
    EXPECT_EQ(cascades({0, 0, 512, 512}).size(), all);
    EXPECT_EQ(cascades({}).size(), 1u);
    const auto centred = cascades({250, 250, 260, 260});
    EXPECT_EQ(centred.size(), all - 1);
    // No probe of the one left out, nor of the last one left, has anything beyond its start.
    const double reach = std::hypot(260.0 + 16, 260.0 + 16);
    EXPECT_GT(plan_cascades({512, 512}, 725, cascade_settings(Quality::standard))[centred.size()].start, reach);
}

TEST(Region, KeepsTheProbesThatItAsks) {
    std::vector<CascadePlan> list = plan_cascades({512, 512}, 725, cascade_settings(Quality::standard));
    const std::vector<CascadePlan> whole = list;
    keep_probes_near(list, {{100, 200}, {40, 30}});
    EXPECT_EQ(list[0].probes, glm::ivec2(40, 30));
    EXPECT_EQ(list[0].first_probe, glm::dvec2(100.5, 200.5));
    for (std::size_t c = 1; c < list.size(); ++c) {
        EXPECT_LE(list[c].probes.x, whole[c].probes.x);
        EXPECT_EQ(list[c].texture, list[c].probes * list[c].tiles);
        // Between two probes of the cascade above, or at the end of the whole grid.
        const CascadePlan& low = list[c - 1];
        for (const int axis : {0, 1}) {
            const double last = list[c].first_probe[axis] + (list[c].probes[axis] - 1) * list[c].spacing;
            const double whole_last = whole[c].first_probe[axis] + (whole[c].probes[axis] - 1) * whole[c].spacing;
            EXPECT_TRUE(list[c].first_probe[axis] <= low.first_probe[axis] || list[c].first_probe[axis] == whole[c].first_probe[axis]);
            EXPECT_TRUE(last >= low.first_probe[axis] + (low.probes[axis] - 1) * low.spacing || last == whole_last);
        }
    }
}

}  // namespace
}  // namespace penumbra
