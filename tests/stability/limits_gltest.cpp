// SPDX-License-Identifier: MIT
// Loops that the driver ends, and marches that run out of steps: blocked and counted, never free.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/stability/judge.h"
#include "tests/stability/ledger.h"
#include "tests/support/build_scene.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

TEST(Limits, TheLoopLimitIsMeasuredAtStart) {
    const DeviceInfo& device = shared_renderer().device();
    // None found, or one that leaves room for a march (glsl/cascade.h) twice.
    if (device.max_loop_iterations != 0) {
        EXPECT_GT(device.max_loop_iterations, 2 * 32'000);
        EXPECT_LE(device.max_loop_iterations, 65'535);
    }
    hold("loop limit", "device", "iterations, in 100,000", device.max_loop_iterations / 1e5, "measured when the renderer starts");
}

// Two walls of many edges, half a pixel apart, and a lamp at one end: rays between them ask an outline at each quarter of a pixel.
Scene long_slit(int length) {
    Scene scene = canvas(length, 8);
    scene.shapes.push_back(shape(Rect{{-6, 4}, {4, 30}, 0, 0}, Colour(1)));
    scene.canvas.margin = 10;
    for (const double side : {-1.0, 1.0}) {
        Polygon wall;
        for (int i = 0; i <= 10; ++i) wall.points.push_back({length * i / 10.0, 4.5 + side * (0.6 + 0.01 * (i % 2))});
        wall.points.push_back({double(length), 4.5 + side * 3});
        wall.points.push_back({0, 4.5 + side * 3});
        scene.shapes.push_back(shape(wall));
    }
    return scene;
}

TEST(Limits, RaysThatRunOutOfStepsAreBlockedAndCounted) {
    const Scene scene = long_slit(4000);
    const ImageF truth = truth_of(scene);
    for (const char* method : {"hrc", "rc_fix", "rc"}) {
        const Way way{method, Quality::draft};
        Scene asked = as(scene, way);
        const RenderResult result = shared_renderer().render(asked);
        const ImageF& picture = std::get<ImageF>(result.picture);
        EXPECT_EQ(impossible(scene, picture), "") << method;
        std::printf("%s: %llu rays ran out of steps\n", method, static_cast<unsigned long long>(result.stats.lost_rays));
        // Never more light than is due, by more than sampling makes.
        double more = 0;
        for (std::size_t i = 0; i < truth.data.size(); ++i)
            if (std::isfinite(truth.data[i])) more = std::max(more, double(picture.data[i]) - double(truth.data[i]));
        hold("out of steps", way, "excess of peak", more, "a slit of 4,000 px between walls of 13 edges");
        hold("out of steps", way, "lost rays, millions", double(result.stats.lost_rays) / 1e6, "a slit of 4,000 px between walls of 13 edges");
        if (way.method == "rc") { EXPECT_GT(result.stats.lost_rays, 0u) << method; }
        Scene easy = as(long_slit(60), way);
        EXPECT_EQ(shared_renderer().render(easy).stats.lost_rays, 0u) << method;
    }
    Scene solved = as(scene, {"exact", Quality::draft});
    EXPECT_EQ(shared_renderer().render(solved).stats.lost_rays, 0u);
}

}  // namespace
}  // namespace penumbra::test
