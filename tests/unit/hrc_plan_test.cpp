// SPDX-License-Identifier: MIT
// The lattices of holographic radiance cascades: arithmetic without a device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/device_error.h"
#include "core/plan/plan.h"
#include "core/plan/sky.h"

namespace penumbra {
namespace {

constexpr Quality kQualities[] = {Quality::draft, Quality::standard, Quality::high};
constexpr glm::ivec2 kSizes[] = {{1, 1}, {1, 90}, {97, 1}, {2, 3}, {509, 257}, {64, 64}, {65, 33}, {8192, 16}};

TEST(PlanHrc, TheTopLevelSpansEveryColumnAndTheOneBelowDoesNot) {
    for (const glm::ivec2 size : kSizes)
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 0.4, 31.0})
                for (const HrcQuadrant& q : plan_hrc(size, margin, hrc_settings(quality)).quadrants) {
                    ASSERT_GE(q.top(), 1);
                    EXPECT_EQ(q.levels.back().planes, 1);
                    EXPECT_GE(1 << q.top(), q.columns);
                    if (q.top() > 1) {
                        EXPECT_LT(1 << (q.top() - 1), q.columns);
                    }
                }
}

TEST(PlanHrc, PlanesCoverEveryColumnAndRaysAreTwiceAsManyALevel) {
    const HrcPlan plan = plan_hrc({509, 257}, 3, {1.0, 2, 4, 0.25});
    for (const HrcQuadrant& q : plan.quadrants)
        for (int n = 0; n <= q.top(); ++n) {
            const HrcLevel& level = q.levels[static_cast<std::size_t>(n)];
            EXPECT_GE(level.planes << n, q.columns);
            EXPECT_LT((level.planes - 1) << n, q.columns);
            EXPECT_EQ(level.cones, 1 << n);
            EXPECT_EQ(level.rays, level.cones + 1);
        }
    EXPECT_EQ(plan_hrc({8, 8}, 0, {1.0, 1, 4, 0.25}).quadrants[0].levels[0].cones, 2);
}

TEST(PlanHrc, ConesOfALevelAddUpToAQuarterTurnAndHalveExactly) {
    for (const int climb : {1, 2})
        for (const int level : {0, 1, 5, 9}) {
            double sum = 0;
            for (int i = 0; i < (2 << level) / climb; ++i) {
                const double angle = hrc_cone_angle(level, climb, i);
                EXPECT_GT(angle, 0);
                EXPECT_NEAR(hrc_cone_angle(level + 1, climb, 2 * i) + hrc_cone_angle(level + 1, climb, 2 * i + 1), angle, 1e-14);
                sum += angle;
            }
            EXPECT_NEAR(sum, 0.5 * std::numbers::pi, 1e-12);
        }
}

TEST(PlanHrc, LatticesAreCentredAndCoverTheDomain) {
    for (const glm::ivec2 size : kSizes)
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 0.4, 31.0}) {
                const HrcSettings settings = hrc_settings(quality);
                const HrcPlan plan = plan_hrc(size, margin, settings);
                const glm::dvec2 last = plan.first_point + glm::dvec2(plan.points - 1) * settings.cell_px;
                EXPECT_EQ(plan.first_point + last, glm::dvec2(size));
                for (const HrcQuadrant& q : plan.quadrants) {
                    // The far end of columns and both ends of rows lie no more than a cell inside the domain.
                    const glm::dvec2 far = q.first + double(q.columns - 1) * q.along + double(q.rows - 1) * q.across;
                    const glm::dvec2 lo = glm::dvec2(std::min(q.first.x, far.x), std::min(q.first.y, far.y));
                    const glm::dvec2 hi = glm::dvec2(std::max(q.first.x, far.x), std::max(q.first.y, far.y));
                    if (q.along.x <= 0) {
                        EXPECT_LT(lo.x, -margin + settings.cell_px);
                    }
                    if (q.along.y <= 0) {
                        EXPECT_LT(lo.y, -margin + settings.cell_px);
                    }
                    if (q.along.x >= 0) {
                        EXPECT_GT(hi.x, size.x + margin - settings.cell_px);
                    }
                    if (q.along.y >= 0) {
                        EXPECT_GT(hi.y, size.y + margin - settings.cell_px);
                    }
                }
            }
}

TEST(PlanHrc, AtOneCellAPixelLatticePointsArePixelCentres) {
    const HrcPlan plan = plan_hrc({7, 4}, 2.5, {1.0, 1, 4, 0.25});
    EXPECT_TRUE(plan.aligned());
    EXPECT_EQ(plan.points, glm::ivec2(7, 4));
    EXPECT_EQ(plan.first_point, glm::dvec2(0.5, 0.5));
    EXPECT_EQ(plan.quadrants[0].first, glm::dvec2(0.5, -2.5));  // right: from the view's left end, rows from the margin on
    EXPECT_EQ(plan.quadrants[2].first, glm::dvec2(6.5, -2.5));  // left
    EXPECT_EQ(plan.quadrants[3].first, glm::dvec2(-2.5, 3.5));  // up
    EXPECT_FALSE(plan_hrc({7, 4}, 0, {2.0, 1, 4, 0}).aligned());
}

TEST(HrcCones, OfAConstantSkyAreItTimesTheirAngle) {
    Sky sky;
    sky.radiance = {1, 2, 3};
    const HrcPlan plan = plan_hrc({21, 13}, 0, hrc_settings(Quality::standard));
    const std::vector<glm::vec4> table = hrc_cones(plan, sky, 2.0);
    const HrcLevel& last = plan.quadrants[3].levels.back();
    ASSERT_EQ(table.size(), static_cast<std::size_t>(last.first_cone + last.cones));
    for (const glm::vec4& cone : table) {
        EXPECT_GT(cone.a, 0);
        EXPECT_NEAR(cone.r, 0.5 * double(cone.a), 1e-6);
        EXPECT_NEAR(cone.b, 1.5 * double(cone.a), 1e-6);
    }
}

TEST(HrcCones, OfAGradientLookWhereTheirQuadrantsFace) {
    Sky sky;
    // Red to the right, green down, blue to the left, white up; steps at the diagonals.
    const Colour colours[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (int i = 0; i < 4; ++i)
        for (const int k : {i, (i + 1) % 4}) sky.gradient.push_back({45.0 + 90 * i, colours[k]});
    const HrcPlan plan = plan_hrc({16, 16}, 0, hrc_settings(Quality::standard));
    const std::vector<glm::vec4> table = hrc_cones(plan, sky, 1.0);
    for (std::size_t i = 0; i < 4; ++i)
        for (const HrcLevel& level : plan.quadrants[i].levels)
            for (int k = 0; k < level.cones; ++k) {
                const glm::vec4 cone = table[static_cast<std::size_t>(level.first_cone + k)];
                EXPECT_NEAR(cone.r, colours[i].r * double(cone.a), 1e-6) << i;
                EXPECT_NEAR(cone.g, colours[i].g * double(cone.a), 1e-6) << i;
                EXPECT_NEAR(cone.b, colours[i].b * double(cone.a), 1e-6) << i;
            }
}

TEST(HrcCones, WithinAQuadrantFollowItsRows) {
    // Light only from 0 to 30 degrees: the last cones of the right quadrant, none of the others'.
    Sky sky;
    sky.gradient = {{0, {0, 0, 0}}, {0, {1, 1, 1}}, {30, {1, 1, 1}}, {30, {0, 0, 0}}};
    const HrcPlan plan = plan_hrc({32, 32}, 0, hrc_settings(Quality::standard));
    const std::vector<glm::vec4> table = hrc_cones(plan, sky, 1.0);
    const auto light = [&](std::size_t quadrant, int level, int cone) {
        return table[static_cast<std::size_t>(plan.quadrants[quadrant].levels[static_cast<std::size_t>(level)].first_cone + cone)].r;
    };
    EXPECT_EQ(light(0, 1, 0), 0);                                           // right, 45 degrees upwards
    EXPECT_EQ(light(0, 1, 1), 0);
    EXPECT_NEAR(light(0, 1, 2), hrc_cone_angle(1, 1, 2), 1e-6);             // 0 to 26.6 degrees
    EXPECT_NEAR(light(0, 1, 3), std::numbers::pi / 6 - std::atan(0.5), 1e-6);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(light(1, 1, k), 0);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(light(3, 1, k), 0);
}

Scene hrc_scene(int width, int height, Quality quality) {
    Scene scene;
    scene.canvas.width = width;
    scene.canvas.height = height;
    scene.sky.radiance = Colour(3);
    Shape shape;
    shape.geometry = Circle{{5, 5}, 2};
    scene.shapes.push_back(shape);
    scene.render.method = "hrc";
    scene.render.quality = quality;
    return scene;
}

TEST(MakePlan, HrcRunsWhenAskedFor) {
    const Plan plan = make_plan(hrc_scene(40, 30, Quality::standard), {});
    EXPECT_EQ(plan.method, "hrc");
    EXPECT_TRUE(plan.hrc.active());
    EXPECT_TRUE(plan.cascades.empty());
    EXPECT_FALSE(plan.resolve);
    EXPECT_FALSE(plan.half_floats);
    EXPECT_GE(plan.gpu_bytes, hrc_bytes(plan.hrc, 16));
}

TEST(MakePlan, HrcIsLeftOutWhereNothingEmits) {
    Scene scene = hrc_scene(40, 30, Quality::standard);
    scene.sky.radiance = Colour(0);
    const Plan plan = make_plan(scene, {});
    EXPECT_FALSE(plan.hrc.active());
    EXPECT_TRUE(std::any_of(plan.skipped.begin(), plan.skipped.end(), [](const SkippedWork& s) { return s.what == "all passes"; }));
}

TEST(MakePlan, HrcTakesHalfFloatsWhenLargeAndIsRefusedWhenTooLarge) {
    const Plan plan = make_plan(hrc_scene(2048, 2048, Quality::standard), {});
    EXPECT_TRUE(plan.half_floats);
    EXPECT_EQ(plan.radiance_scale, 3);
    EXPECT_THROW(make_plan(hrc_scene(8192, 8192, Quality::standard), {}), DeviceError);
    EXPECT_THROW(make_plan(hrc_scene(4096, 4096, Quality::high), {}), DeviceError);
    // The same picture is none too large for rc.
    Scene scene = hrc_scene(8192, 8192, Quality::standard);
    scene.render.method = "rc";
    EXPECT_NO_THROW(make_plan(scene, {}));
}

}  // namespace
}  // namespace penumbra
