// SPDX-License-Identifier: MIT
// What a floor sends up: pictures, relief and gloss, against closed forms and the errata's figures.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/floor/floor.h"
#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

std::shared_ptr<const Texels> texels(int width, int height, std::vector<std::uint8_t> rgba) {
    auto made = std::make_shared<Texels>();
    made->width = width;
    made->height = height;
    made->rgba = std::move(rgba);
    return made;
}

std::shared_ptr<const Texels> facing(std::uint8_t r, std::uint8_t g, std::uint8_t b) { return texels(1, 1, {r, g, b, 255}); }

Colour value(const Scene& scene, Point p) { return reference::ExactSolver(scene).value(p); }

Scene lit_scene() {
    Scene scene = empty_scene();
    scene.canvas.floor_albedo = Colour(0.9, 0.6, 0.3);
    scene.sky.gradient = {{0, Colour(0.1)}, {200, Colour(0.5, 0.4, 0.3)}};
    add(scene, disc({30, 40}, 6), Colour(3, 2, 1));
    add(scene, box({60, 60}, {20, 5}));
    scene.lights.push_back(PointLight{{80, 20}, Colour(10)});
    PointLight lamp{{20, 80}, Colour(900)};
    lamp.unit = LightUnit::lumens;
    lamp.height = 8;
    scene.lights.push_back(lamp);
    DirectionalLight sun{70, Colour(0.2)};
    sun.elevation_deg = 40;
    scene.lights.push_back(sun);
    return scene;
}

TEST(Floor, AFlatNormalMapIsThePlainPicture) {
    const Scene plain = lit_scene();
    Scene flat = plain;
    flat.canvas.floor.normals = facing(128, 128, 255);
    for (const Point p : {Point(50, 50), Point(12, 70), Point(85, 25), Point(90, 90)}) {
        const Colour a = value(plain, p), b = value(flat, p);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(b[c], a[c], 1e-9 * a[c]) << p.x << " " << p.y;
    }
}

TEST(Floor, AlbedoMultipliesPictures) {
    Scene scene = lit_scene();
    const Colour before = value(scene, {50, 50});
    scene.canvas.floor.image = facing(255, 188, 0);
    const Colour after = value(scene, {50, 50});
    EXPECT_NEAR(after.r, before.r, 1e-12);
    EXPECT_NEAR(after.g, before.g * std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-9);
    EXPECT_EQ(after.b, 0);
}

TEST(Floor, PicturesLieWhereTheySay) {
    Canvas canvas;
    canvas.width = 4;
    canvas.height = 2;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 8; ++i) rgba.insert(rgba.end(), {std::uint8_t(255 * (i % 2)), std::uint8_t(i < 4 ? 255 : 0), 0, 255});
    canvas.floor.image = texels(4, 2, rgba);
    const auto at = [&](double x, double y) { return Floor(canvas).at({x, y}).albedo; };
    // As large as the canvas: texel by texel.
    EXPECT_EQ(at(0.5, 0.5), Colour(0, 1, 0));
    EXPECT_EQ(at(1.5, 1.5), Colour(1, 0, 0));
    // Twice as large: linear between centres.
    canvas.floor.tile = ViewRect{0, 0, 8, 4};
    EXPECT_NEAR(at(1.5, 0.5).r, 0.25, 1e-12);
    // Half as large: the mean of four, and twice across.
    canvas.floor.tile = ViewRect{0, 0, 2, 1};
    EXPECT_NEAR(at(0.5, 0.5).r, 0.5, 1e-12);
    EXPECT_NEAR(at(0.5, 0.5).g, 0.5, 1e-12);
    // It repeats.
    canvas.floor.tile = ViewRect{-4, 0, 4, 2};
    EXPECT_EQ(at(1.5, 1.5), Colour(1, 0, 0));
    canvas.floor.tile = ViewRect{1, 0, 4, 2};
    EXPECT_EQ(at(0.5, 0.5), Colour(1, 1, 0));
}

TEST(Floor, NormalsAreDecodedAsTheyAreDrawn) {
    const std::uint8_t flat[] = {128, 128, 255}, right[] = {255, 128, 128}, up[] = {128, 255, 128}, lowest[] = {0, 1, 128};
    EXPECT_EQ(decoded_normal(flat), glm::dvec3(0, 0, 1));
    EXPECT_EQ(decoded_normal(right), glm::dvec3(1, 0, 0));
    EXPECT_EQ(decoded_normal(up), glm::dvec3(0, -1, 0));
    EXPECT_EQ(decoded_normal(lowest), glm::dvec3(-1, 1, 0));
}

// Of a disc of radiance 1: it spans 2 asin(R / D), and its directions add up to 2 R / D.
TEST(Floor, MomentsOfADiscInClosedForm) {
    Scene scene = empty_scene();
    add(scene, disc({30, 40}, 6), Colour(1));
    scene.canvas.floor.normals = facing(128 + 60, 128 - 30, 128 + 100);
    const glm::dvec3 normal = Floor(scene.canvas).at({50, 50}).normal;
    const double size = std::hypot(normal.x, normal.y);
    EXPECT_NEAR(normal.x / normal.y, 60.0 / 30, 1e-12);
    const FloorResponse::OfField terms = FloorResponse({}).of_field(normal.z);
    for (const Point p : {Point(80, 20), Point(35, 80), Point(10, 10)}) {
        const double far = distance(p, {30, 40});
        const Point way = (Point(30, 40) - p) / far;
        const double lean = (way.x * normal.x + way.y * normal.y) / size * (6 / far) / kPi;
        const double expected = terms.mean.diffuse * std::asin(6 / far) / kPi + terms.lean.diffuse * lean;
        EXPECT_NEAR(value(scene, p).r, std::max(expected, 0.0), 1e-12);
    }
}

TEST(Floor, MomentsOfASkyGradient) {
    Scene scene = empty_scene();
    scene.sky.gradient = {{0, Colour(0)}, {180, Colour(1)}};  // brightest to the left
    scene.canvas.floor.normals = facing(128 - 60, 128, 128 + 100);
    const glm::dvec3 normal = Floor(scene.canvas).at({50, 50}).normal;
    const FloorResponse::OfField terms = FloorResponse({}).of_field(normal.z);
    // A triangle's first moment: 1 / (2 pi) * 2 * integral of (t / pi) cos t = -2 / pi^2.
    EXPECT_NEAR(value(scene, {20, 20}).r, terms.mean.diffuse * 0.5 + terms.lean.diffuse * 2 / (kPi * kPi), 1e-9);
}

TEST(Floor, ASurfaceThatLeansALittle) {
    // Light from everywhere: n.z. From one side alone: pi / 2 times the lean, to second order.
    for (const double t : {0.01, 0.05, 0.1}) {
        const FloorResponse::OfField terms = FloorResponse({}).of_field(std::cos(t));
        EXPECT_NEAR(terms.mean.diffuse, std::cos(t), t * t);
        EXPECT_NEAR(terms.lean.diffuse, 0.5 * kPi * std::sin(t), t * t);
    }
}

TEST(Floor, TheTableIsTheIntegral) {
    for (const double roughness : {0.1, 0.3, 0.7, 1.0}) {
        const FloorResponse response(Gloss{roughness, 0.5, 0.5});
        for (const double degrees : {3.3, 17.0, 41.0, 66.0}) {
            // By brute force over the upper half.
            const double z = std::cos(degrees * kPi / 180);
            const glm::dvec3 normal(std::sqrt(1 - z * z), 0, z);
            const int up = 300, around = 450;
            double mean[3] = {}, lean[3] = {};
            for (int i = 0; i < up; ++i) {
                for (int k = 0; k < around; ++k) {
                    const double e = (i + 0.5) * kPi / 2 / up, s = std::sin(e), c = std::cos(e), w = (k + 0.5) * 2 * kPi / around;
                    const ResponseTerms f = response.of_beam(normal, {c * std::cos(w), c * std::sin(w), s});
                    const double share = 2 * kPi / around * kPi / 2 / up * c;
                    const double all[3] = {f.diffuse, f.facets, f.rim};
                    for (int n = 0; n < 3; ++n) {
                        mean[n] += all[n] * share;
                        lean[n] += 2 * all[n] * share * std::cos(w);
                    }
                }
            }
            const FloorResponse::OfField terms = response.of_field(z);
            const auto near = [&](const ResponseTerms& a, const double (&b)[3]) {
                EXPECT_NEAR(a.diffuse, b[0], 3e-3) << roughness << " " << degrees;
                EXPECT_NEAR(a.facets, b[1], 0.025) << roughness << " " << degrees;
                EXPECT_NEAR(a.rim, b[2], 0.005) << roughness << " " << degrees;
            };
            near(terms.mean, mean);
            near(terms.lean, lean);
        }
    }
}

TEST(Floor, ABeamFollowsTheCosine) {
    Scene scene = empty_scene();
    scene.canvas.floor_albedo = Colour(0.5);
    scene.canvas.floor.normals = facing(128 + 50, 128 + 30, 128 + 110);
    PointLight lamp{{20, 30}, Colour(700)};
    lamp.unit = LightUnit::candela;
    lamp.height = 25;
    scene.lights.push_back(lamp);
    const glm::dvec3 n = glm::normalize(glm::dvec3(50, -30, 110));
    for (const Point p : {Point(60, 30), Point(20, 90), Point(3, 5)}) {
        const glm::dvec3 way(20 - p.x, 30 - p.y, 25);
        const double squared = glm::dot(way, way);
        const double cosine = std::max(glm::dot(n, way) / std::sqrt(squared), 0.0);
        EXPECT_NEAR(value(scene, p).r, 0.5 * 700 * cosine / squared / kPi, 1e-9) << p.x;
    }
    // Turned away it is dark.
    scene.canvas.floor.normals = facing(255, 128, 128);
    EXPECT_EQ(value(scene, {60, 30}).r, 0);
    EXPECT_GT(value(scene, {3, 30}).r, 0);
}

TEST(Floor, ALampInFlatlandAndADiscOfTheSameLight) {
    Scene lamp = empty_scene(), point = lamp;
    add(lamp, disc({30, 40}, 0.01), Colour(5 / 0.02));
    point.lights.push_back(PointLight{{30, 40}, Colour(5)});
    for (Scene* scene : {&lamp, &point}) scene->canvas.floor.normals = facing(128 - 40, 128 + 20, 128 + 100);
    EXPECT_NEAR(value(lamp, {70, 60}).r, value(point, {70, 60}).r, 1e-6);
}

// ---- gloss: the errata's figures

Gloss gloss(double roughness, double metallic = 0, double reflectance = 0.5) { return {roughness, metallic, reflectance}; }

TEST(Gloss, BurleySeenFromAbove) {  // E-23
    for (const auto& [alpha, right] : {std::pair{1.0, 1.036}, {0.0, 0.976}}) {
        double sum = 0;
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double nl = (i + 0.5) / steps;
            sum += burley_diffuse(nl, 1, std::sqrt(0.5 + 0.5 * nl), alpha) * nl * 2 * kPi / steps;
        }
        EXPECT_NEAR(sum, right, 1e-3);
    }
    // Straight up it is 1 / pi, whatever the roughness: F0 and F90 have not changed places.
    EXPECT_NEAR(burley_diffuse(1, 1, 1, 0) * kPi, 1, 1e-12);
    EXPECT_NEAR(burley_diffuse(1, 1, 1, 1) * kPi, 1, 1e-12);
}

TEST(Gloss, WhatRoughFacetsLose) {  // E-28
    EXPECT_NEAR(FloorResponse(gloss(1)).mirrored(1), 0.307, 2e-3);
    EXPECT_NEAR(FloorResponse(gloss(0.1)).mirrored(1), 1, 5e-3);
}

TEST(Gloss, AWhiteRoomStaysWhite) {  // E-28
    for (const double roughness : {0.0, 0.2, 0.5, 0.8, 1.0}) {
        for (const double metallic : {0.0, 0.5, 1.0}) {
            Scene scene = empty_scene();
            scene.sky.radiance = Colour(1);
            scene.canvas.floor.gloss = gloss(roughness, metallic);
            const double sent = value(scene, {50, 50}).r;
            EXPECT_LE(sent, 1.035) << roughness << " " << metallic;
            // Half a metal loses some: what it mirrors less than a metal it does not scatter.
            EXPECT_GE(sent, metallic == 0.5 ? 0.55 : 0.94) << roughness << " " << metallic;
            if (metallic == 1) {
                EXPECT_NEAR(sent, 1, 1e-3) << roughness;  // all that it takes it gives back
            }
        }
    }
}

TEST(Gloss, MetalIsNotBlack) {  // E-24
    Scene scene = empty_scene();
    scene.sky.radiance = Colour(1);
    scene.canvas.floor_albedo = Colour(1.0, 0.766, 0.336);
    scene.canvas.floor.gloss = gloss(0.2, 1);
    const Colour gold = value(scene, {50, 50});
    EXPECT_NEAR(gold.r, 1, 0.01);
    EXPECT_NEAR(gold.g, 0.766, 0.02);
    EXPECT_NEAR(gold.b, 0.336, 0.03);
}

TEST(Gloss, PlasticHasAWhiteHighlight) {  // E-25
    Scene scene = empty_scene();
    scene.canvas.floor_albedo = Colour(1, 0, 0);
    scene.canvas.floor.gloss = gloss(0.3);
    PointLight lamp{{50, 50}, Colour(100)};
    lamp.unit = LightUnit::candela;
    lamp.height = 10;
    scene.lights.push_back(lamp);
    const Colour top = value(scene, {50, 50});
    // Head on: F0 = 0.04, D = 1 / (pi alpha^2), V = 1 / 4.
    const double alpha = 0.09;
    const double compensated = 0.04 * (1 + 0.04 * (1 / FloorResponse(gloss(0.3)).mirrored(1) - 1));
    EXPECT_NEAR(top.g, compensated / (kPi * alpha * alpha) / 4, 1e-4 * top.g);
    EXPECT_NEAR(top.b, top.g, 1e-12);
    EXPECT_NEAR(top.r - top.g, (1 - 0.04) / kPi, 1e-4);
    EXPECT_LT(value(scene, {80, 50}).g, 0.01 * top.g);
}

TEST(Gloss, NothingIsUndefined) {  // E-26, E-27
    for (const double roughness : {0.0, 0.045, 1.0}) {
        const FloorResponse response(gloss(roughness, 0.5));
        for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::normalize(glm::dvec3(1, 0, 1e-9))}) {
            for (const glm::dvec3& light : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::normalize(glm::dvec3(0, 1, 1e-9))}) {
                const ResponseTerms terms = response.of_beam(normal, light);
                EXPECT_TRUE(std::isfinite(terms.diffuse) && std::isfinite(terms.facets) && std::isfinite(terms.rim));
            }
            const ResponseColours colours = response.colours(Colour(1), normal.z);
            EXPECT_TRUE(std::isfinite(colours.facets.r));
        }
    }
}

}  // namespace
}  // namespace penumbra::truth
