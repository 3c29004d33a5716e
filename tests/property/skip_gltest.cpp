// SPDX-License-Identifier: MIT
// What is skipped is not missed: each scene renders to the same bytes with `render.skip: "none"`, which runs everything.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/plan/plan.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

void expect_same_without_skipping(Scene scene, const char* what) {
    for (const auto& [method, quality] : {std::pair("rc", Quality::draft), std::pair("rc", Quality::standard), std::pair("exact", Quality::standard)}) {
        scene.render.method = method;
        scene.render.quality = quality;
        scene.render.skip = Skip::all;
        const Plan lean = make_plan(scene, {});
        const ImageF skipped = render_linear(scene);
        const Image8 shown = render_display(scene);
        scene.render.skip = Skip::none;
        const Plan full = make_plan(scene, {});
        EXPECT_GE(lean.skipped.size(), full.skipped.size()) << what;
        EXPECT_TRUE(full.skipped.empty()) << what;
        EXPECT_EQ(render_linear(scene).data, skipped.data) << what;
        EXPECT_EQ(render_display(scene).data, shown.data) << what;
    }
}

TEST(Skip, ChangesNoByte) {
    expect_same_without_skipping(canvas(37, 29), "an empty scene");
    Scene sky = canvas(37, 29);
    sky.sky.radiance = {0.3, 0.5, 0.7};
    expect_same_without_skipping(sky, "a sky alone");
    const Shape dark = shape(Circle{{11.3, 14.2}, 5.1});
    expect_same_without_skipping(with(canvas(37, 29), {dark}), "a dark shape");
    expect_same_without_skipping(with(sky, {dark, shape(Rect{{25.2, 9.7}, {9, 4}, 20, 0}, Colour(2))}), "lamp, shape and sky");
}

// Hundreds of shapes, so that the distance pass asks lists of them.
TEST(Skip, ListsOfNearShapesChangeNoByte) {
    Numbers numbers(4);
    Scene scene = canvas(90, 70);
    scene.sky.radiance = {0.1, 0.2, 0.3};
    for (int i = 0; i < 300; ++i) {
        const Point at{numbers.between(0, 90), numbers.between(0, 70)};
        const Colour light(numbers.next() < 0.3 ? numbers.between(0, 3) : 0.0);
        const Geometry geometries[] = {Circle{at, numbers.between(0.2, 2)}, Ellipse{at, {2, 0.7}, numbers.between(0, 360)},
                                       Rect{at, {3, 1}, numbers.between(0, 360), 0.3}, Line{at, at + Point(3, 1), 0.4},
                                       Polyline{{at, at + Point(3, 1), at + Point(-1, 2)}, 0.3, false},
                                       Polygon{{at, at + Point(3, 1), at + Point(-1, 2), at + Point(2, 2)}},
                                       Bitmap{picture(3, 3, [](int x, int y) { return x != y; }), at, {3, 3}}};
        scene.shapes.push_back(shape(geometries[i % 7], light));
    }
    expect_same_without_skipping(scene, "300 shapes");
    const RenderStats stats = shared_renderer().render(scene).stats;
    const auto found = std::find_if(stats.skipped.begin(), stats.skipped.end(),
                                    [](const SkippedWork& w) { return w.what == "distances to far shapes"; });
    ASSERT_NE(found, stats.skipped.end());
    EXPECT_GT(found->saved, 200.0 * 90 * 70);
    scene.render.skip = Skip::none;
    EXPECT_TRUE(shared_renderer().render(scene).stats.skipped.empty());
}

}  // namespace
}  // namespace penumbra::test
