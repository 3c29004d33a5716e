// SPDX-License-Identifier: MIT
// Lights in lumens, candela and lux: what they send, added up, is what was asked for (errata E-17 to E-22).
#include <gtest/gtest.h>

#include "core/film/exposure.h"
#include "core/scene/photometry.h"
#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

Scene with_light(const Light& light) {
    Scene scene = empty_scene();
    scene.lights.push_back(light);
    return scene;
}

// Illuminance of the floor.
double lux_at(reference::ExactSolver& solver, Point p) { return kPi * solver.delta_radiance(p).r; }

double lux_at(const Scene& scene, Point p) {
    reference::ExactSolver solver(scene);
    return lux_at(solver, p);
}

PointLight lamp(Point at, double amount, LightUnit unit, double height) {
    PointLight light{at, Colour(amount)};
    light.unit = unit;
    light.height = height;
    return light;
}

SpotLight beam(double inner, double outer, double amount, LightUnit unit, double tilt, double height = 10) {
    SpotLight light{{50, 50}, 30, inner, outer, Colour(amount)};
    light.unit = unit;
    light.height = height;
    light.tilt_deg = tilt;
    return light;
}

TEST(Photometric, AQuarterAtTwiceTheDistance) {
    const Scene one = with_light(lamp({50, 50}, 7, LightUnit::candela, 1)), two = with_light(lamp({50, 50}, 7, LightUnit::candela, 2));
    EXPECT_NEAR(lux_at(one, {50, 50}), 7, 1e-12);
    EXPECT_NEAR(lux_at(two, {50, 50}), 7.0 / 4, 1e-12);
    // Aside the light comes slanted: I h / d^3.
    EXPECT_NEAR(lux_at(two, {53, 54}), 7 * 2 / std::pow(29.0, 1.5), 1e-12);
}

TEST(Photometric, LumensAddUpOverTheSphere) {
    for (const auto& [inner, outer] : {std::pair{20.0, 30.0}, {0.0, 45.0}, {25.0, 25.0}, {10.0, 170.0}, {0.0, 0.01}, {180.0, 180.0}}) {
        const SpotLight spot = beam(inner, outer, 800, LightUnit::lumens, 0);
        const double candela = candela_of(spot).r;
        const int steps = 20000;
        double flux = 0;
        for (int i = 0; i < steps; ++i) {  // over the cone alone: nothing is beyond
            const double angle = (i + 0.5) / steps * outer * kPi / 180;
            flux += 2 * kPi * candela * spot_share(spot, angle) * std::sin(angle) * outer * kPi / 180 / steps;
        }
        EXPECT_NEAR(flux, 800, 0.05) << inner << " " << outer;
    }
    EXPECT_NEAR(candela_of(lamp({0, 0}, 800, LightUnit::lumens, 1)).g * 4 * kPi, 800, 1e-9);
    // Full and half angle: a cone of half angle 30 has the solid angle 2 pi (1 - cos 30).
    EXPECT_NEAR(spot_solid_angle(beam(30, 30, 1, LightUnit::lumens, 0)), 2 * kPi * (1 - std::cos(kPi / 6)), 1e-12);
}

TEST(Photometric, LumensAddUpOverTheFloor) {
    // Half of a lamp's light goes down; within R all but h / sqrt(R^2 + h^2) of that arrives.
    reference::ExactSolver solver(with_light(lamp({50, 50}, 800, LightUnit::lumens, 5)));
    const int steps = 4000;
    const double reach = 45;
    double flux = 0;
    for (int i = 0; i < steps; ++i) {
        const double r = (i + 0.5) * reach / steps;
        flux += lux_at(solver, {50 + r * 0.6, 50 + r * 0.8}) * 2 * kPi * r * reach / steps;
    }
    EXPECT_NEAR(flux, 400 * (1 - 5 / std::hypot(reach, 5)), 1e-3);
    // A spot that looks down sends everything to the floor: straight, and at a slant.
    for (const double tilt : {90.0, 65.0}) {
        reference::ExactSolver spot(with_light(beam(15, 30, 800, LightUnit::lumens, tilt)));
        double sum = 0;
        for (double y = 20.125; y < 90; y += 0.25)
            for (double x = 20.125; x < 90; x += 0.25) sum += lux_at(spot, {x, y}) / 16;
        EXPECT_NEAR(sum, 800, 1) << tilt;
    }
}

TEST(Photometric, ASpotsAxisPointsWhereItSays) {
    // 10 above the floor and 45 degrees down: it meets the floor 10 away.
    const Scene scene = with_light(beam(1, 2, 5, LightUnit::candela, 45));
    const Point foot{50 + 10 * std::cos(kPi / 6), 50 + 10 * std::sin(kPi / 6)};
    EXPECT_NEAR(lux_at(scene, foot), 5 / 200.0 * std::sqrt(0.5), 1e-12);
    EXPECT_EQ(lux_at(scene, {50, 50}), 0);
    // The ramp is squared, of cosines: 1.5 degrees aside.
    const double far = 10 / std::tan(43.5 * kPi / 180);
    const auto cosine = [](double d) { return std::cos(d * kPi / 180); };
    const double ramp = (cosine(1.5) - cosine(2)) / (cosine(1) - cosine(2));
    const double squared = far * far + 100;
    EXPECT_NEAR(lux_at(scene, {50 + far * std::cos(kPi / 6), 50 + far * std::sin(kPi / 6)}), 5 * ramp * ramp * 10 / std::pow(squared, 1.5), 1e-9);
}

TEST(Photometric, TheSunInLux) {
    DirectionalLight sun{90, Colour(1e5)};
    sun.elevation_deg = 30;
    Scene scene = with_light(sun);
    add(scene, box({50, 50}, {20, 10}));
    EXPECT_NEAR(lux_at(scene, {20, 90}), 5e4, 1e-8);
    EXPECT_EQ(lux_at(scene, {50, 90}), 0);  // shadows are flatland's
    // 18 % grey under 100,000 lx at EV 15: 0.146 (errata E-22).
    sun.elevation_deg = 90;
    Scene grey = with_light(sun);
    grey.canvas.floor_albedo = Colour(0.18);
    grey.output.camera = Camera{16, 1.0 / 128, 100};
    EXPECT_NEAR(reference::ExactSolver(grey).value({50, 50}).r * exposure_factor(grey.output), 0.146, 5e-4);
}

TEST(Photometric, FlatShadowsAndBothKindsTogether) {
    Scene scene = with_light(lamp({10, 50}, 900, LightUnit::candela, 4));
    add(scene, disc({50, 50}, 10));
    EXPECT_EQ(lux_at(scene, {80, 50}), 0);
    EXPECT_GT(lux_at(scene, {80, 80}), 0);
    const double raised = lux_at(scene, {30, 70}) / kPi;
    scene.lights.push_back(PointLight{{30, 40}, Colour(10)});
    EXPECT_NEAR(lux_at(scene, {30, 70}) / kPi, raised + 10 / (2 * kPi * 30), 1e-12);
}

TEST(Photometric, WallsShineWithWhatTheyGet) {
    // A wall under the illuminance E cos(elevation) shines with rho / pi of it.
    DirectionalLight sun{90, Colour(3)};
    sun.elevation_deg = 60;
    Scene scene = with_light(sun);
    add(scene, box({50, 80}, {40, 20}), Colour(0), Colour(0.5));
    scene.render.bounces = 1;
    const double span = 2 * std::atan(20.0 / 30) / (2 * kPi);
    EXPECT_NEAR(phi(scene, {50, 40}), 0.5 * 3 * std::cos(kPi / 3) / kPi * span, 1e-10);
    // A lamp 5 above the floor, 20 before the middle of a wide wall: straight before it the irradiance is I r / d^3.
    Scene room = with_light(lamp({50, 50}, 100, LightUnit::candela, 5));
    add(room, box({50, 80}, {400, 20}), Colour(0), Colour(1));
    room.render.bounces = 1;
    // Seen from close by the wall is as bright as its nearest part.
    EXPECT_NEAR(phi(room, {50, 69.99}), 0.5 * 100 * 20 / std::pow(425.0, 1.5) / kPi, 1e-4);
}

}  // namespace
}  // namespace penumbra::truth
