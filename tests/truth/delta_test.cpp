// SPDX-License-Identifier: MIT
// Point, spot and directional lights.
#include <gtest/gtest.h>

#include "tests/truth/scenes.h"

namespace penumbra::truth {
namespace {

double delta_at(const Scene& scene, Point p, int channel = 0) {
    return reference::ExactSolver(scene).delta_radiance(p)[channel];
}

Scene with_light(const Light& light) {
    Scene scene = empty_scene();
    scene.lights.push_back(light);
    return scene;
}

TEST(DeltaLights, PointFallsWithDistance) {
    const Scene scene = with_light(PointLight{{30, 40}, Colour(10, 20, 40)});
    EXPECT_NEAR(delta_at(scene, {60, 80}, 0), 10 / (2 * kPi * 50), 1e-14);
    EXPECT_NEAR(delta_at(scene, {60, 80}, 2), 40 / (2 * kPi * 50), 1e-14);
    // Not below half a pixel.
    EXPECT_NEAR(delta_at(scene, {30.1, 40}), 10 / (2 * kPi * 0.5), 1e-12);
    EXPECT_NEAR(delta_at(scene, {30, 40}), 10 / (2 * kPi * 0.5), 1e-12);
    EXPECT_EQ(phi(scene, {60, 80}), 0);
}

TEST(DeltaLights, PointCastsAShadow) {
    Scene scene = with_light(PointLight{{10, 50}, Colour(1)});
    add(scene, disc({50, 50}, 10));
    // The tangent from the light leaves at asin(10 / 40): at x = 90 it is at height 80 tan.
    const double height = 80 * std::tan(std::asin(0.25));
    EXPECT_EQ(delta_at(scene, {90, 50 + height - 1e-6}), 0);
    EXPECT_GT(delta_at(scene, {90, 50 + height + 1e-6}), 0);
    EXPECT_GT(delta_at(scene, {39, 50}), 0);
    EXPECT_EQ(delta_at(scene, {61, 50}), 0);
}

TEST(DeltaLights, ALightMayStandOutsideTheDomain) {
    Scene scene = with_light(PointLight{{-60, 50}, Colour(1)});
    add(scene, disc({-20, 50}, 10));  // outside: blocks nothing
    EXPECT_NEAR(delta_at(scene, {40, 50}), 1 / (2 * kPi * 100), 1e-14);
    add(scene, disc({20, 50}, 5));
    EXPECT_EQ(delta_at(scene, {40, 50}), 0);
}

TEST(DeltaLights, InsideASolidItLightsNothingOnAnOutlineTheOutside) {
    Scene inside = with_light(PointLight{{50, 50}, Colour(1)});
    add(inside, disc({50, 50}, 5));
    EXPECT_EQ(delta_at(inside, {80, 50}), 0);
    Scene on = with_light(PointLight{{55, 50}, Colour(1)});
    add(on, disc({50, 50}, 5));
    EXPECT_NEAR(delta_at(on, {80, 50}), 1 / (2 * kPi * 25), 1e-12);
    EXPECT_NEAR(delta_at(on, {60, 70}), 1 / (2 * kPi * distance({60, 70}, {55, 50})), 1e-12);
    EXPECT_EQ(delta_at(on, {20, 50}), 0);
}

TEST(DeltaLights, SpotFallsOffBetweenItsAngles) {
    const Scene scene = with_light(SpotLight{{50, 50}, 90, 10, 30, Colour(8)});
    const auto at = [&](double degrees) {
        const double a = (90 + degrees) * kPi / 180;
        return delta_at(scene, {50 + 20 * std::cos(a), 50 + 20 * std::sin(a)});
    };
    const double full = 8 / (2 * kPi * 20);
    EXPECT_NEAR(at(0), full, 1e-12);
    EXPECT_NEAR(at(-9.9), full, 1e-12);
    EXPECT_EQ(at(30.1), 0);
    EXPECT_EQ(at(180), 0);
    const auto cosine = [](double d) { return std::cos(d * kPi / 180); };
    const double ramp = (cosine(20) - cosine(30)) / (cosine(10) - cosine(30));
    EXPECT_NEAR(at(20), full * ramp * ramp, 1e-12);
    EXPECT_NEAR(at(-20), full * ramp * ramp, 1e-12);
}

TEST(DeltaLights, SpotWithAHardEdge) {
    const Scene scene = with_light(SpotLight{{50, 50}, 0, 25, 25, Colour(1)});
    const auto at = [&](double degrees) {
        const double a = degrees * kPi / 180;
        return delta_at(scene, {50 + 20 * std::cos(a), 50 + 20 * std::sin(a)});
    };
    EXPECT_NEAR(at(24.999), 1 / (2 * kPi * 20), 1e-12);
    EXPECT_EQ(at(25.001), 0);
    const Scene wide = with_light(SpotLight{{50, 50}, 0, 180, 180, Colour(1)});
    EXPECT_NEAR(delta_at(wide, {30, 50}), 1 / (2 * kPi * 20), 1e-12);
}

TEST(DeltaLights, DirectionalIsEvenButForShadows) {
    Scene scene = with_light(DirectionalLight{90, Colour(3)});  // travels down the screen
    add(scene, box({50, 50}, {20, 10}));
    EXPECT_NEAR(delta_at(scene, {20, 90}), 3 / (2 * kPi), 1e-14);
    EXPECT_EQ(delta_at(scene, {50, 90}), 0);
    EXPECT_EQ(delta_at(scene, {59.999, 90}), 0);
    EXPECT_NEAR(delta_at(scene, {60.001, 90}), 3 / (2 * kPi), 1e-14);
    EXPECT_NEAR(delta_at(scene, {50, 40}), 3 / (2 * kPi), 1e-14);
}

TEST(DeltaLights, TheFloorMultipliesThem) {
    Scene scene = with_light(PointLight{{30, 40}, Colour(10)});
    scene.canvas.floor_albedo = Colour(0.5, 0.25, 0);
    scene.sky.radiance = Colour(1);
    const Colour value = reference::ExactSolver(scene).value({60, 80});
    const double sum = 1 + 10 / (2 * kPi * 50);
    EXPECT_NEAR(value.r, 0.5 * sum, 1e-12);
    EXPECT_NEAR(value.g, 0.25 * sum, 1e-12);
    EXPECT_EQ(value.b, 0);
}

TEST(DeltaLights, TheyLightSurfacesOnlyWithBounces) {
    // A beam across a wall that faces it: irradiance E, Lo = rho E / 2.
    Scene scene = with_light(DirectionalLight{90, Colour(3)});
    add(scene, box({50, 80}, {40, 20}), Colour(0), Colour(0.5));
    EXPECT_EQ(phi(scene, {50, 40}), 0);
    scene.render.bounces = 1;
    const double span = 2 * std::atan(20.0 / 30) / (2 * kPi);
    EXPECT_NEAR(phi(scene, {50, 40}), 0.5 * 3 / 2 * span, 1e-10);
    // With a shadow edge half way along: half of it, to the accuracy of the refined elements.
    add(scene, box({40, 10}, {20, 4}));
    add(scene, box({35, 10}, {30, 4}));
    EXPECT_NEAR(phi(scene, {50, 40}), 0.5 * 3 / 2 * span / 2, 1e-5);
}

}  // namespace
}  // namespace penumbra::truth
