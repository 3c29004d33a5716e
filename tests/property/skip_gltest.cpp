// SPDX-License-Identifier: MIT
// What is skipped is not missed. Each kind of skipped work by itself, and all of it (`render.skip: "none"` runs everything),
// on small scenes and on random ones: the same bytes, or within a bound that is stated here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/plan/plan.h"
#include "core/plan/saving.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

struct Bound {
    double linear = 0;       // of a linear value, relative to itself and a twentieth of the mean
    double share_above = 0;  // of values that may be beyond that
    int shown = 0;           // of an 8-bit code, for what changes how a picture is composed
};

// What leaving this out may change.
Bound bound_of(Saving saving, const std::string& method) {
    switch (saving) {
        // Summed on the host instead of by the method: rounding.
        case Saving::constant: return {2e-6, 0, 1};
        // Marches take other steps where a shape outside the domain no longer shortens them; what grazes a corner may
        // be met or missed. The other methods have no rays so long.
        case Saving::shapes: return method == "rc" || method == "rc_fix" ? Bound{2e-2, 1e-2, 0} : Bound{};
        // Under a sky, the means of directions are of other cascades: rounding.
        case Saving::levels: return {2e-6, 0, 1};
        // What the interpolation may err by: the tolerance of `standard`, where a cell keeps to it.
        case Saving::cells: return {1.2e-2, 2e-3, 0};
        default: return {};
    }
}

// The share of values that differ by more than the bound.
double share_beyond(const ImageF& a, const ImageF& b, double bound) {
    const double floor = 0.05 * mean(b);
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < a.data.size(); ++i)
        if (!(std::abs(double(a.data[i]) - double(b.data[i])) <= bound * (std::abs(double(b.data[i])) + floor))) ++beyond;
    return double(beyond) / double(a.data.size());
}

void expect_harmless(Scene scene, const std::string& what, const std::vector<const char*>& methods = {"rc", "hrc", "exact", "hybrid"}) {
    for (const char* method : methods) {
        scene.render.method = method;
        scene.render.skip = Skip::all;
        scene.render.keep = 0;
        const ImageF lean = render_linear(scene);
        const Image8 shown = render_display(scene);
        Bound all;
        for (const SavingName& one : kSavings) {
            scene.render.keep = std::uint32_t(one.saving);
            const Bound bound = bound_of(one.saving, method);
            all.linear += bound.linear;
            all.share_above += bound.share_above;
            const std::string name = what + ", " + method + ", without leaving out: " + std::string(one.name);
            const ImageF linear = render_linear(scene);
            if (bound.linear > 0) {
                EXPECT_LE(share_beyond(lean, linear, bound.linear), bound.share_above) << name;
            } else {
                EXPECT_EQ(lean.data, linear.data) << name;
            }
            // Composing differs by these alone.
            if (one.saving == Saving::programs || one.saving == Saving::constant) {
                EXPECT_LE(difference(shown, render_display(scene)).max, bound.shown) << name;
            }
        }
        scene.render.keep = 0;
        scene.render.skip = Skip::none;
        EXPECT_TRUE(make_plan(scene, {}).skipped.empty()) << what;
        const RenderResult full = shared_renderer().render(scene);
        EXPECT_TRUE(full.stats.skipped.empty()) << what;
        EXPECT_LE(share_beyond(lean, render_linear(scene), all.linear), all.share_above) << what << ", " << method << ": all";
    }
}

Scene random_scene(std::uint64_t seed, int shapes, double beyond) {
    Numbers numbers(seed);
    Scene scene = canvas(70, 60);
    scene.canvas.margin = seed % 2 == 0 ? 0 : 7;
    if (seed % 3 != 0) scene.sky.radiance = {0.1, 0.2, 0.3};
    if (seed % 3 == 2) scene.sky.gradient = {{0, Colour(0.1)}, {120, Colour(0.5, 0.2, 0)}, {300, Colour(0, 0.1, 0.4)}};
    for (int i = 0; i < shapes; ++i) {
        const Point at{numbers.between(-beyond, 70 + beyond), numbers.between(-beyond, 60 + beyond)};
        const double size = numbers.between(0.5, 6);
        const Colour light(numbers.next() < 0.3 ? numbers.between(0, 3) : 0.0);
        const Geometry geometries[] = {Circle{at, size}, Ellipse{at, {size, 0.4 * size}, numbers.between(0, 360)},
                                       Rect{at, {2 * size, size}, numbers.between(0, 360), 0.1 * size}, Line{at, at + Point(size, 1), 0.4 * size},
                                       Polyline{{at, at + Point(size, 1), at + Point(-1, size)}, 0.3 * size, false},
                                       Polygon{{at, at + Point(size, 1), at + Point(-1, size), at + Point(2, 2)}},
                                       Bitmap{picture(3, 3, [&](int x, int y) { return seed % 2 == 0 && x != y; }), at, {size, size}}};
        scene.shapes.push_back(shape(geometries[i % 7], light));
    }
    return scene;
}

TEST(Skip, IsHarmlessWithoutShapes) {
    expect_harmless(canvas(37, 29), "an empty scene");
    Scene sky = canvas(37, 29);
    sky.sky.radiance = {0.3, 0.5, 0.7};
    expect_harmless(sky, "a sky alone");
    sky.canvas.floor_albedo = {0.2, 0.9, 0.5};
    sky.output.tonemap = "agx";
    sky.output.exposure_ev = 1.5;
    expect_harmless(sky, "a sky alone, displayed");
    sky.sky.gradient = {{10, Colour(0.1, 0.4, 0.2)}, {200, Colour(2, 0, 1)}};
    expect_harmless(sky, "a gradient alone", {"rc", "rc_fix", "hrc", "exact"});
    // Not by rc_fix: its beams take in some of what is beside them, even outside the domain.
    sky.shapes = {shape(Circle{{60, 10}, 22.9}), shape(Rect{{-90, -90}, {20, 20}, 45, 0}, Colour(5))};
    expect_harmless(sky, "a gradient, shapes outside");
}

TEST(Skip, IsHarmlessWithFewShapes) {
    Scene sky = canvas(37, 29);
    sky.sky.radiance = {0.3, 0.5, 0.7};
    const Shape dark = shape(Circle{{11.3, 14.2}, 5.1});
    expect_harmless(with(canvas(37, 29), {dark}), "a dark shape");
    expect_harmless(with(sky, {dark, shape(Rect{{25.2, 9.7}, {9, 4}, 20, 0}, Colour(2))}), "lamp, shape and sky");
    // A lamp in the middle of a wide canvas: the last cascade of rc sees nothing.
    expect_harmless(with(canvas(120, 110), {shape(Circle{{60.3, 54.2}, 4}, Colour(3, 2, 1)), shape(Line{{20, 20}, {40, 33}, 1.5})}), "a lamp in the middle");
}

TEST(Skip, IsHarmlessWithClosedOffRegions) {
    Scene scene = canvas(120, 110);
    scene.sky.radiance = {0.3, 0.5, 0.7};
    // A room of strokes with a pillar, a ring, and a lit room beside.
    scene.shapes = {shape(Polyline{{{8, 9}, {70, 12}, {66, 80}, {9, 77}}, 2.5, true}), shape(Rect{{30, 40}, {9, 14}, 20, 2}),
                    shape(Polyline{{{76, 12}, {112, 12}, {112, 60}, {76, 60}}, 2, true}), shape(Circle{{95, 30}, 3}, Colour(4, 2, 1)),
                    shape(Circle{{90, 100}, 4}, Colour(1, 2, 3))};
    expect_harmless(scene, "a dark room and a lit one", {"exact"});
    const RenderResult result = shared_renderer().render([&] {
        Scene s = scene;
        s.render.method = "exact";
        return s;
    }());
    bool named = false;
    for (const SkippedWork& one : result.stats.skipped) named = named || one.what == "closed-off pixels";
    EXPECT_TRUE(named);
}
TEST(Skip, IsHarmlessOnRandomScenes) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) expect_harmless(random_scene(seed, 30, 30), "random scene " + std::to_string(seed));
}

TEST(Skip, LeavesOutFarDistancesOfManyShapes) {
    Scene scene = random_scene(4, 300, 0);
    expect_harmless(scene, "300 shapes", {"rc", "exact"});
    const RenderStats stats = shared_renderer().render(scene).stats;
    const auto found = std::find_if(stats.skipped.begin(), stats.skipped.end(),
                                    [](const SkippedWork& w) { return w.what == "distances to far shapes"; });
    ASSERT_NE(found, stats.skipped.end());
    EXPECT_GT(found->saved, 200.0 * 70 * 60);
}

TEST(Skip, AConstantPictureRunsNoPass) {
    Scene scene = canvas(301, 203, "png");
    scene.shapes = {shape(Circle{{50, 50}, 20}), shape(Circle{{-400, 50}, 20}, Colour(9))};
    const RenderResult dark = shared_renderer().render(scene);
    for (const PassStats& pass : dark.stats.passes) EXPECT_LE(pass.dispatches, 1u) << pass.name;
    const Image8& picture = std::get<Image8>(dark.picture);
    EXPECT_EQ(picture.width, 301);
    EXPECT_TRUE(std::all_of(picture.data.begin(), picture.data.end(), [](auto v) { return v == 0; }));
    scene.shapes[0].emission = Colour(1);
    const RenderResult lit = shared_renderer().render(scene);
    EXPECT_GT(lit.stats.passes.size(), 3u);
}

}  // namespace
}  // namespace penumbra::test
