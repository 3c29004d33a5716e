// SPDX-License-Identifier: MIT
// The outline as the method `exact` packs it, how it divides the work, and what `auto` chooses. No device.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/plan/choose.h"
#include "core/plan/exact_plan.h"
#include "core/plan/pack_outline.h"
#include "core/plan/plan.h"
#include "glsl/exact.h"
#include "tests/support/build_scene.h"

namespace penumbra::test {
namespace {

constexpr std::size_t kPlenty = 100'000;
constexpr int kStraight = 0, kDisc = 1, kArc = 2, kEllipse = 3;
using Counts = std::array<int, 4>;

PackedOutline packed(const Scene& scene, bool survey = false) { return pack_outline(scene, 1.0, survey, kPlenty); }

// Texels that an entry of each kind takes.
constexpr int kTexels[] = {1, 1, 2, 4};

// Where the entries of a kind start.
std::size_t first_of(const PackedOutline& outline, int kind) {
    std::size_t at = 0;
    for (int k = 0; k < kind; ++k) at += std::size_t(kTexels[k] * outline.counts[std::size_t(k)]);
    return at;
}

bool shines(const PackedOutline& outline, int kind, int index) {
    const glm::vec4 light = outline.lights_of[first_of(outline, kind) + std::size_t(kTexels[kind] * index)];
    return light.r > 0 || light.g > 0 || light.b > 0;
}

Scene every_kind() {
    return with(canvas(100, 80),
                {shape(Rect{{12, 12}, {8, 6}, 20, 0}), shape(Circle{{40, 12}, 4}), shape(Ellipse{{70, 12}, {6, 3}, 30}),
                 shape(Rect{{15, 50}, {12, 9}, 0, 2}), shape(Polygon{{{40, 40}, {50, 42}, {44, 51}}}, Colour(2)),
                 shape(Circle{{70, 45}, 5}, {1, 2, 3}), shape(Ellipse{{85, 65}, {5, 2}, 10}, Colour(1)),
                 // Two discs of different light that overlap: an arc each.
                 shape(Circle{{40, 68}, 5}, Colour(1)), shape(Circle{{46, 68}, 5})});
}

// ---- pack_outline ----

TEST(PackOutline, CountsPiecesByKind) {
    const PackedOutline outline = packed(every_kind());
    // The rounded rect's corners are hidden by nothing and border on their own light: discs. An arc of more than half a turn
    // comes in three.
    EXPECT_EQ(outline.counts, (Counts{4 + 4 + 3, 2 + 4, 3 + 3, 2}));
    EXPECT_EQ(outline.lights, (Counts{3, 1, 3, 1}));
    EXPECT_EQ(outline.pieces, 25u);
    EXPECT_EQ(outline.emitting, 8u);
    EXPECT_EQ(outline.entries.size(), 11u + 6u + 2u * 6u + 4u * 2u);
    EXPECT_EQ(outline.lights_of.size(), outline.entries.size());
    EXPECT_EQ(outline.bytes(), 32 * outline.entries.size());
    EXPECT_TRUE(outline.fits);
}

TEST(PackOutline, WhatEmitsComesFirstOfItsKind) {
    const PackedOutline outline = packed(every_kind());
    for (int kind = 0; kind < 4; ++kind)
        for (int i = 0; i < outline.counts[std::size_t(kind)]; ++i)
            EXPECT_EQ(shines(outline, kind, i), i < outline.lights[std::size_t(kind)]) << kind << " " << i;
}

TEST(PackOutline, EveryPieceHasItsOwnNumberAndScaledLight) {
    const PackedOutline outline = pack_outline(every_kind(), 4.0, false, kPlenty);
    std::set<float> numbers;
    for (int kind = 0; kind < 4; ++kind)
        for (int i = 0; i < outline.counts[std::size_t(kind)]; ++i)
            numbers.insert(outline.lights_of[first_of(outline, kind) + std::size_t(kTexels[kind] * i)].a);
    EXPECT_EQ(numbers.size(), outline.pieces);
    EXPECT_EQ(glm::vec3(outline.lights_of[first_of(outline, kDisc)]), glm::vec3(0.25f, 0.5f, 0.75f));
}

TEST(PackOutline, IsInPixelsOfTheView) {
    Scene scene = with(canvas(100, 50), {shape(Circle{{1020, -480}, 8})});
    scene.canvas.view = ViewRect{1000, -500, 200, 100};
    const PackedOutline outline = packed(scene);
    ASSERT_EQ(outline.counts, (Counts{0, 1, 0, 0}));
    EXPECT_EQ(glm::vec3(outline.entries[0]), glm::vec3(10, 10, 4));
}

TEST(PackOutline, TheRoundEndsOfACapsuleAreWholeDiscs) {
    const PackedOutline outline = packed(with(canvas(60, 60), {shape(Line{{10, 20}, {40, 30}, 6}, Colour(1))}));
    EXPECT_EQ(outline.counts, (Counts{2, 2, 0, 0}));
    EXPECT_EQ(outline.lights, (Counts{2, 2, 0, 0}));
    std::set<std::pair<float, float>> centres;
    for (std::size_t i = 2; i < 4; ++i) {
        centres.insert({outline.entries[i].x, outline.entries[i].y});
        EXPECT_FLOAT_EQ(outline.entries[i].z, 3);
    }
    EXPECT_EQ(centres, (std::set<std::pair<float, float>>{{10, 20}, {40, 30}}));
    // A stroke of one light crosses another of it: still discs.
    EXPECT_EQ(packed(with(canvas(60, 60), {shape(Line{{10, 20}, {40, 30}, 6}), shape(Line{{10, 22}, {40, 12}, 6})})).counts[kArc], 0);
}

TEST(PackOutline, DiscsOfOneLightThatOverlapAreWholeAndOfAnotherArcs) {
    const auto two = [](Colour first, Colour second) {
        return packed(with(canvas(60, 60), {shape(Circle{{20, 30}, 8}, first), shape(Circle{{29, 31}, 7}, second)}));
    };
    EXPECT_EQ(two(Colour(1), Colour(1)).counts, (Counts{0, 2, 0, 0}));
    EXPECT_EQ(two(Colour(0), Colour(0)).counts, (Counts{0, 2, 0, 0}));
    EXPECT_EQ(two(Colour(1), Colour(0)).counts, (Counts{0, 0, 6, 0})) << "three arcs each";
    EXPECT_EQ(two({1, 0, 0}, {0, 1, 0}).counts, (Counts{0, 0, 6, 0}));
    // The end of a stroke that another light covers in part.
    const PackedOutline end = packed(with(canvas(60, 60), {shape(Line{{10, 30}, {40, 30}, 6}, Colour(1)), shape(Rect{{44, 30}, {4, 20}, 0, 0})}));
    EXPECT_EQ(end.counts[kDisc], 1);
    EXPECT_EQ(end.counts[kArc], 2);
}

TEST(PackOutline, WhatIsHiddenHasNoPieces) {
    const PackedOutline outline = packed(with(canvas(60, 60), {shape(Circle{{30, 30}, 4}, Colour(9)), shape(Circle{{30, 30}, 8})}));
    EXPECT_EQ(outline.counts, (Counts{0, 1, 0, 0}));
    EXPECT_EQ(outline.emitting, 0u);
    EXPECT_EQ(outline.smallest_light, 0);
    EXPECT_EQ(packed(canvas(60, 60)).pieces, 0u);
}

TEST(PackOutline, CornersThatPiecesShareAreEqualToTheBit) {
    Numbers numbers(5);
    for (int scene_number = 0; scene_number < 20; ++scene_number) {
        Scene scene = canvas(200, 160);
        // Coordinates with all digits, a scale that rounds, shapes that cut one another; no two of one light, so that no circle is
        // taken whole and each corner keeps its partners.
        scene.canvas.view = ViewRect{numbers.between(-1e5, 1e5), numbers.between(-1e5, 1e5), 200 * 0.37, 160 * 0.37};
        const auto at = [&] { return Point(scene.canvas.view->x, scene.canvas.view->y) + Point(numbers.between(10, 60), numbers.between(10, 50)); };
        for (int i = 0; i < 12; ++i) {
            const Colour light(i);
            if (i % 3 == 0) scene.shapes.push_back(shape(Circle{at(), numbers.between(2, 9)}, light));
            if (i % 3 == 1) scene.shapes.push_back(shape(Rect{at(), {numbers.between(3, 15), numbers.between(3, 15)}, numbers.between(0, 90), 0}, light));
            if (i % 3 == 2) scene.shapes.push_back(shape(Polygon{{at(), at(), at()}}, light));
        }
        const PackedOutline outline = packed(scene);
        // Straight pieces and arcs run around closed outlines: each corner ends as many pieces as it starts.
        std::map<std::pair<float, float>, int> balance;
        int corners = 0;
        const auto add = [&](glm::vec4 ends) {
            ++balance[{ends.x, ends.y}];
            --balance[{ends.z, ends.w}];
            ++corners;
        };
        for (int i = 0; i < outline.counts[kStraight]; ++i) add(outline.entries[std::size_t(i)]);
        for (int i = 0; i < outline.counts[kArc]; ++i) add(outline.entries[first_of(outline, kArc) + std::size_t(2 * i + 1)]);
        ASSERT_GT(corners, 20);
        for (const auto& [corner, count] : balance) EXPECT_EQ(count, 0) << corner.first << ", " << corner.second << " in scene " << scene_number;
    }
}

TEST(PackOutline, ACircleThatTheDomainCutsOffIsNotWhole) {
    // Its other part is not hidden: it is not there, and must not shine.
    Scene scene = with(canvas(60, 60), {shape(Circle{{30, 61}, 8}, Colour(1))});
    EXPECT_EQ(packed(scene).counts[kDisc], 0);
    EXPECT_GT(packed(scene).counts[kArc], 0);
    scene.canvas.margin = 8;
    EXPECT_EQ(packed(scene).counts[kDisc], 0);
    scene.canvas.margin = 10;
    EXPECT_EQ(packed(scene).counts, (Counts{0, 1, 0, 0}));
    EXPECT_EQ(packed(with(canvas(60, 60), {shape(Line{{30, 40}, {30, 59}, 6})})).counts[kDisc], 1) << "the end inside";
}

TEST(PackOutline, ArcsLieOnTheirCircleAndEllipsesOnTheirFrame) {
    const PackedOutline outline = packed(with(canvas(80, 60), {shape(Circle{{30, 30}, 8}, Colour(1)), shape(Ellipse{{38, 32}, {9, 4}, 25})}));
    ASSERT_EQ(outline.counts[kStraight] + outline.counts[kDisc], 0);
    ASSERT_GT(outline.counts[kArc], 0);
    ASSERT_GT(outline.counts[kEllipse], 0);
    for (int i = 0; i < outline.counts[kArc]; ++i) {
        const glm::vec4 circle = outline.entries[std::size_t(2 * i)], ends = outline.entries[std::size_t(2 * i + 1)];
        EXPECT_EQ(glm::vec3(circle), glm::vec3(30, 30, 8));
        for (const glm::vec2 end : {glm::vec2(ends), glm::vec2(ends.z, ends.w)})
            EXPECT_NEAR(std::hypot(end.x - circle.x, end.y - circle.y), circle.z, 1e-5);
    }
    for (int i = 0; i < outline.counts[kEllipse]; ++i) {
        const glm::vec4* entry = &outline.entries[first_of(outline, kEllipse) + std::size_t(4 * i)];
        const glm::vec4 head = entry[0], frame = entry[1], ends = entry[2], back = entry[3];
        EXPECT_EQ(head.w, 0) << "not whole";
        EXPECT_NEAR(head.z, 9, 1e-6) << "reach";
        for (const glm::vec2 end : {glm::vec2(ends), glm::vec2(ends.z, ends.w)}) {
            const glm::vec2 v = end - glm::vec2(head);
            EXPECT_NEAR(std::hypot(frame.x * v.x + frame.y * v.y, frame.z * v.x + frame.w * v.y), 1, 1e-5);
        }
        // `back` turns the frame back.
        EXPECT_NEAR(frame.x * back.x + frame.y * back.y, 1, 1e-5);
        EXPECT_NEAR(frame.x * back.z + frame.y * back.w, 0, 1e-5);
        EXPECT_NEAR(frame.z * back.z + frame.w * back.w, 1, 1e-5);
    }
    EXPECT_EQ(packed(with(canvas(80, 60), {shape(Ellipse{{38, 32}, {9, 4}, 25})})).entries[0].w, 1) << "whole";
}

TEST(PackOutline, KnowsTheSmallestLightInPixels) {
    Scene scene = with(canvas(100, 80), {shape(Circle{{30, 30}, 8}, Colour(1)), shape(Rect{{60, 30}, {3, 5}, 0, 0}, Colour(1)), shape(Circle{{80, 60}, 0.1})});
    EXPECT_NEAR(packed(scene).smallest_light, 5, 1e-9);
    scene.canvas.view = ViewRect{0, 0, 200, 160};
    EXPECT_NEAR(packed(scene).smallest_light, 2.5, 1e-9);
    scene.shapes.push_back(shape(Circle{{10, 10}, 0.25}, {0, 1e-3, 0}));
    EXPECT_NEAR(packed(scene).smallest_light, 0.25, 1e-9);
}

TEST(PackOutline, ABodyIsMeasuredWholeThoughLittleOfItIsSeen) {
    // A disc whose rim only just shows beside the rect on top.
    const Scene scene = with(canvas(100, 80), {shape(Circle{{42, 40}, 12}), shape(Rect{{40, 40}, {27.8, 40}, 0, 0}, Colour(1))});
    EXPECT_NEAR(packed(scene).smallest_body, 24, 1e-6);
}

TEST(SkyNodes, NumberThePartsBetweenSteps) {
    Sky sky;
    sky.gradient = {{20, Colour(1)}, {100, Colour(1)}, {100, Colour(3)}, {200, Colour(3)}, {200, Colour(1)}};
    const auto part = [&](double degrees) { return sky_nodes(sky, 360, 1.0)[2 * static_cast<std::size_t>(degrees) + 1].a; };
    EXPECT_EQ(part(50), part(250)) << "across angle 0";
    EXPECT_NE(part(150), part(50));
    EXPECT_EQ(part(101), part(199));
    // One step alone has a border at angle 0 as well.
    sky.gradient = {{100, Colour(1)}, {100, Colour(3)}};
    EXPECT_NE(part(150), part(50));
    sky.gradient = {{20, Colour(1)}, {100, Colour(3)}};
    EXPECT_EQ(part(150), part(50)) << "no step, one part";
}

TEST(PackOutline, KnowsTheSmallestBodyInPixels) {
    Scene scene = with(canvas(100, 80), {shape(Circle{{30, 30}, 8}, Colour(1)), shape(Rect{{60, 30}, {3, 5}, 0, 0})});
    EXPECT_NEAR(packed(scene).smallest_body, 5, 1e-9);
    EXPECT_NEAR(packed(scene).smallest_light, 16, 1e-9);
    scene.canvas.view = ViewRect{0, 0, 200, 160};
    EXPECT_NEAR(packed(scene).smallest_body, 2.5, 1e-9);
}

TEST(PackOutline, MoreThanTheMostPiecesDoNotFit) {
    const Scene scene = with(canvas(60, 60), {shape(Rect{{20, 20}, {5, 5}, 0, 0}), shape(Rect{{40, 20}, {5, 5}, 0, 0})});
    EXPECT_TRUE(pack_outline(scene, 1, false, 100).fits);
    EXPECT_FALSE(pack_outline(scene, 1, false, 3).fits);
    EXPECT_EQ(pack_outline(scene, 1, false, 3).pieces, 0u);
}

TEST(PackOutline, TheSurveyCountsWhatAPointTellsApart) {
    EXPECT_EQ(packed(every_kind()).mean_intervals, 0) << "not asked for";
    // A disc in the open: it and what is beside it.
    Scene one = with(canvas(60, 60), {shape(Circle{{30, 30}, 3}, Colour(1))});
    EXPECT_GE(packed(one, true).mean_intervals, 1);
    EXPECT_LE(packed(one, true).mean_intervals, 4);
    Scene many = one;
    many.sky.radiance = Colour(1);
    for (int i = 0; i < 40; ++i) many.shapes.push_back(shape(Circle{{1.3 + 1.4 * i, 3 + 7.7 * (i % 8)}, 0.5}));
    EXPECT_GT(packed(many, true).mean_intervals, 20);
}

// ---- the sky ----

TEST(SkyNodes, IntegrateAConstantSky) {
    Sky sky;
    sky.radiance = {1, 2, 4};
    const std::vector<glm::vec4> nodes = sky_nodes(sky, 16, 2.0);
    ASSERT_EQ(nodes.size(), 2u * 17u);
    for (std::size_t i = 0; i <= 16; ++i) {
        const double angle = double(i) * std::numbers::pi / 8;
        EXPECT_NEAR(nodes[2 * i].r, 0.5 * angle, 1e-6);
        EXPECT_NEAR(nodes[2 * i].b, 2 * angle, 2e-6);
        EXPECT_FLOAT_EQ(nodes[2 * i + 1].g, 1);
    }
}

TEST(SkyNodes, IntegrateAGradient) {
    // From 0 at 0 degrees to 3 at 90, back to 0 at 360: 3 x^2 / pi up to a quarter turn, then a falling line.
    Sky sky;
    sky.gradient = {{0, Colour(0)}, {90, {3, 0, 0}}};
    const double pi = std::numbers::pi;
    const auto integral = [&](double x) {
        const double up = std::min(x, pi / 2);
        const double down = std::max(x - pi / 2, 0.0);
        return 3 * up * up / pi + 3 * down - down * down / pi;
    };
    const int count = 2048;
    const std::vector<glm::vec4> nodes = sky_nodes(sky, count, 1.0);
    for (int i = 0; i <= count; ++i) {
        const double x = 2 * pi * i / count;
        EXPECT_NEAR(nodes[std::size_t(2 * i)].r, integral(x), 2e-6);
        const double radiance = x < pi / 2 ? 6 * x / pi : 3 - 2 * (x - pi / 2) / pi;
        EXPECT_NEAR(nodes[std::size_t(2 * i + 1)].r, radiance, 2e-6);
        EXPECT_EQ(nodes[std::size_t(2 * i)].g, 0);
    }
    EXPECT_NEAR(nodes[std::size_t(2 * count)].r, 3 * pi, 1e-5);
}

// ---- exact_plan ----

PackedOutline of_pieces(std::size_t pieces) {
    PackedOutline outline;
    outline.pieces = pieces;
    return outline;
}

TEST(PlanExact, MorePiecesWantNarrowerSectorsAndCoarseLists) {
    const Scene scene = canvas(640, 480);
    int before = 0;
    for (const std::size_t pieces : {0u, 4u, 5u, 24u, 25u, 48u, 49u, 400u, 401u, 100000u}) {
        const ExactPlan plan = plan_exact(scene, of_pieces(pieces), {640, 480}, true);
        EXPECT_TRUE(plan.used);
        EXPECT_GE(plan.sectors, std::max(before, 8));
        EXPECT_LE(plan.sectors, 64);
        EXPECT_EQ(plan.outline.pieces, pieces);
        EXPECT_EQ(plan.coarse_tile, pieces > 48 ? 64 : 0);
        before = plan.sectors;
    }
    EXPECT_EQ(plan_exact(scene, of_pieces(1), {640, 480}, true).sectors, 8);
    EXPECT_EQ(before, 64);
}

TEST(PlanExact, BandsAreWholeTilesAndCoverLittleEnough) {
    for (const glm::ivec2 canvas_size : {glm::ivec2(1, 1), glm::ivec2(640, 480), glm::ivec2(8192, 8192), glm::ivec2(16384, 3), glm::ivec2(3, 16384)})
        for (const std::size_t pieces : {3u, 1000u})
            for (const bool software : {true, false}) {
                const ExactPlan plan = plan_exact(canvas(1, 1), of_pieces(pieces), canvas_size, software);
                const int unit = plan.coarse_tile > 0 ? plan.coarse_tile : glsl::kExactTile;
                EXPECT_GT(plan.band_rows, 0);
                EXPECT_EQ(plan.band_rows % unit, 0);
                EXPECT_LE(std::size_t(plan.band_rows) * std::size_t(canvas_size.x), std::size_t(software ? 1 << 21 : 1 << 23));
            }
}

TEST(PlanExact, CountsTheBytesOfABand) {
    ExactPlan plan = plan_exact(canvas(1, 1), {}, {33, 20}, true);
    EXPECT_EQ(exact_bytes(plan, {33, 20}), 49u * 33u * 56u);
    plan.band_rows = 16;
    EXPECT_EQ(exact_bytes(plan, {33, 20}), 49u * 17u * 56u);
    Scene scene = with(canvas(640, 480), {shape(Circle{{64, 64}, 10}, Colour(1))});
    scene.render.method = "exact";
    EXPECT_GE(make_plan(scene, {}).gpu_bytes, 640u * 480u * (8 + 4 + 16 + 56)) << "distance, composed picture, radiance, points";
}

TEST(PlanExact, AGradientSkyHasNodes) {
    Scene scene = canvas(64, 64);
    EXPECT_EQ(plan_exact(scene, {}, {64, 64}, true).sky_nodes, 0);
    scene.sky.gradient = {{0, Colour(1)}, {90, Colour(2)}};
    EXPECT_GT(plan_exact(scene, {}, {64, 64}, true).sky_nodes, 0);
}

TEST(PlanExact, PointsOfAllLevelsAreThoseOfATile) {
    std::size_t sum = 0;
    for (int level = 0; level < 4; ++level) sum += exact_level_points(level);
    EXPECT_EQ(sum, 17u * 17u);
    EXPECT_EQ(exact_level_points(0), 9u) << "the corners of four cells of eight pixels";
    EXPECT_EQ(exact_level_points(1), 16u);
}

TEST(PlanExact, BetterQualityToleratesLessAndSmallerLightsWantSmallerCells) {
    const ExactSettings draft = exact_settings(Quality::draft, 4, 4), standard = exact_settings(Quality::standard, 4, 4), high = exact_settings(Quality::high, 4, 4);
    EXPECT_GT(draft.tolerance, standard.tolerance);
    EXPECT_GT(standard.tolerance, high.tolerance);
    EXPECT_GE(draft.kink_cell, standard.kink_cell);
    EXPECT_GE(standard.kink_cell, high.kink_cell);
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) {
        int before = 1;
        for (const double light : {0.01, 0.5, 1.0, 3.0, 8.0, 1000.0}) {
            const int cell = exact_settings(quality, light, 8).kink_cell;
            EXPECT_GE(cell, before);
            EXPECT_LE(cell, glsl::kExactCell);
            EXPECT_EQ(cell & (cell - 1), 0);
            before = cell;
        }
        EXPECT_EQ(exact_settings(quality, 0.01, 8).kink_cell, 1);
        // A body smaller than a cell could hide its shadow in it, but for the sky's light, which has none so sharp.
        EXPECT_EQ(exact_settings(quality, 5, 100).largest_cell, 8);
        EXPECT_EQ(exact_settings(quality, 5, 5).largest_cell, 4);
        EXPECT_EQ(exact_settings(quality, 5, 0.1).largest_cell, 1);
        EXPECT_EQ(exact_settings(quality, 0, 0.1).largest_cell, 8);
    }
}

// ---- auto ----

Scene small_discs(int count) {
    Numbers numbers(9);
    Scene scene = canvas(512, 512);
    for (int i = 0; i < count; ++i)
        scene.shapes.push_back(shape(Circle{{numbers.between(0, 512), numbers.between(0, 512)}, 1.1}, Colour(i % 4 == 0 ? 1.0 : 0.0)));
    return scene;
}

TEST(Choose, ADiscIsSolvedAndThousandsAreSampled) {
    const Scene disc = with(canvas(128, 128), {shape(Circle{{64, 64}, 10}, Colour(1))});
    const MethodChoice solved = choose_method(packed(disc, true));
    EXPECT_EQ(solved.method, "exact");
    EXPECT_NE(solved.reason.find("1 pieces"), std::string::npos) << solved.reason;
    const PackedOutline crowd = packed(small_discs(3000), true);
    const MethodChoice sampled = choose_method(crowd);
    EXPECT_EQ(sampled.method, "hrc");
    EXPECT_NE(sampled.reason.find(std::to_string(crowd.pieces)), std::string::npos) << sampled.reason;
    EXPECT_NE(sampled.reason.find(std::to_string(static_cast<int>(std::round(crowd.mean_intervals)))), std::string::npos) << sampled.reason;
    EXPECT_GT(exact_cost(crowd), 100 * exact_cost(packed(disc, true)));
}

TEST(Choose, WhatDoesNotFitIsSampled) {
    PackedOutline outline;
    outline.fits = false;
    const MethodChoice choice = choose_method(outline);
    EXPECT_EQ(choice.method, "hrc");
    EXPECT_NE(choice.reason.find(std::to_string(most_surveyed_pieces())), std::string::npos) << choice.reason;
}

TEST(Choose, ThePlanDoesAsChosenAndSaysWhy) {
    Scene scene = with(canvas(128, 128), {shape(Circle{{64, 64}, 10}, Colour(1))});
    scene.render.method = "auto";
    const Plan plan = make_plan(scene, {});
    EXPECT_EQ(plan.method, "exact");
    EXPECT_TRUE(plan.exact.used);
    EXPECT_TRUE(plan.cascades.empty());
    EXPECT_EQ(plan.exact.outline.pieces, 1u);
    EXPECT_NE(plan.method_reason.find("1 pieces"), std::string::npos) << plan.method_reason;
    const Plan refused = make_plan(scene, {}, "too dense");
    EXPECT_EQ(refused.method, "hrc");
    EXPECT_EQ(refused.method_reason, "too dense");
    EXPECT_FALSE(refused.exact.used);
    Scene crowd = small_discs(3000);
    crowd.render.method = "auto";
    const Plan sampled = make_plan(crowd, {});
    EXPECT_EQ(sampled.method, "hrc");
    EXPECT_FALSE(sampled.exact.used);
    EXPECT_TRUE(sampled.hrc.active());
    // A picture too large for hrc's memory.
    crowd.canvas.width = crowd.canvas.height = 8192;
    crowd.canvas.view = ViewRect{0, 0, 512, 512};
    EXPECT_EQ(make_plan(crowd, {}).method, "rc");
    scene.render.method = "rc";
    EXPECT_EQ(make_plan(scene, {}).method, "rc");
    EXPECT_EQ(make_plan(scene, {}).method_reason, "asked for");
}

TEST(Choose, NothingToRenderIsStillPlanned) {
    Scene scene = canvas(32, 32);
    scene.render.method = "auto";
    const Plan plan = make_plan(scene, {});
    EXPECT_EQ(plan.method, "exact");
    EXPECT_FALSE(plan.exact.used) << "nothing emits";
    EXPECT_FALSE(plan.skipped.empty());
}

}  // namespace
}  // namespace penumbra::test
