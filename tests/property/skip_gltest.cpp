// SPDX-License-Identifier: MIT
// What is skipped is not missed: each scene renders to the same bytes with `render.skip: "none"`, which runs everything.
#include <gtest/gtest.h>

#include "core/plan/plan.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

void expect_same_without_skipping(Scene scene, const char* what) {
    for (const Quality quality : {Quality::draft, Quality::standard}) {
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

}  // namespace
}  // namespace penumbra::test
