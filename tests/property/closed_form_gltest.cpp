// SPDX-License-Identifier: MIT
// A disc of radius R and radiance 1 seen from r away fills asin(R / r) / pi of all directions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

struct Ring {
    double energy = 0;    // mean over mean, less 1
    double relative = 0;  // mean of |a - b| / b
};

Ring ring_of(int side, Point centre, Quality quality, double from = 40, double to = 60) {
    constexpr double kRadius = 10;
    Scene scene = with(rc_canvas(side, side), {shape(Circle{centre, kRadius}, Colour(1))});
    scene.render.quality = quality;
    const ImageF picture = render_linear(scene);
    Ring ring;
    double sum = 0;
    double exact_sum = 0;
    int pixels = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
            if (r < from || r > to) continue;
            const double exact = std::asin(kRadius / r) / std::numbers::pi;
            const double value = double(picture.at(x, y)[1]);
            sum += value;
            exact_sum += exact;
            ring.relative += std::abs(value / exact - 1);
            ++pixels;
        }
    ring.energy = sum / exact_sum - 1;
    ring.relative /= pixels;
    return ring;
}

TEST(ClosedForm, ADiscInAnEmptyCanvasOf512) {
    const Ring ring = ring_of(512, {256, 256}, Quality::standard);
    std::printf("disc of 10 px in 512x512, ring 40 to 60 px: energy %+.2f %%, mean relative error %.2f %%\n", 100 * ring.energy, 100 * ring.relative);
    RecordProperty("energy_percent", std::to_string(100 * ring.energy));
    RecordProperty("mean_relative_error_percent", std::to_string(100 * ring.relative));
    EXPECT_LE(std::abs(ring.energy), 0.03);
}

// Bounds from measurement on llvmpipe, rounded up.
struct Case {
    Quality quality;
    const char* name;
    double energy, relative;
};

TEST(ClosedForm, OffTheGridAtEveryQuality) {
    for (const Case& c : {Case{Quality::draft, "draft", 0.03, 0.04}, Case{Quality::standard, "standard", 0.015, 0.025}, Case{Quality::high, "high", 0.01, 0.02}})
        for (const Point centre : {Point(80, 80), Point(80.5, 79.5), Point(77.3, 82.6), Point(83.71, 76.09)}) {
            const Ring ring = ring_of(160, centre, c.quality);
            std::printf("%s, centre %g, %g: energy %+.2f %%, mean relative error %.2f %%\n", c.name, centre.x, centre.y, 100 * ring.energy, 100 * ring.relative);
            EXPECT_LE(std::abs(ring.energy), c.energy) << c.name << " " << centre.x << ", " << centre.y;
            EXPECT_LE(ring.relative, c.relative) << c.name << " " << centre.x << ", " << centre.y;
        }
}

}  // namespace
}  // namespace penumbra::test
