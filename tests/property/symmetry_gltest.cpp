// SPDX-License-Identifier: MIT
// A moved scene gives the moved picture.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/plan/plan.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

// Lamps and walls of all types within the middle of a canvas; `map` moves points, `angle` turns directions.
struct Move {
    std::function<Point(Point)> map = [](Point p) { return p; };
    double turned_deg = 0;
    bool mirrors = false;
    double scale = 1;
    double angle(double degrees) const { return (mirrors ? -degrees : degrees) + turned_deg; }
};

std::vector<Shape> moved_shapes(Point centre, double unit, const Move& move) {
    const auto at = [&](double x, double y) { return move.map(centre + unit * Point(x, y)); };
    const double s = unit * move.scale;
    return {shape(Circle{at(-0.42, -0.31), 0.11 * s}, {3, 2, 1}),
            shape(Rect{at(0.13, 0.05), {0.11 * s, 0.7 * s}, move.angle(12), 0.02 * s}),
            shape(Ellipse{at(0.52, 0.33), {0.17 * s, 0.08 * s}, move.angle(40)}, {0, 0.5, 2}),
            shape(Line{at(-0.3, 0.42), at(-0.1, 0.57), 0.05 * s}, {0.3, 0.3, 0}),
            shape(Polygon{{at(-0.7, 0.2), at(-0.55, 0.28), at(-0.66, 0.5)}}),
            shape(Polyline{{at(0.4, -0.6), at(0.65, -0.45), at(0.45, -0.25)}, 0.06 * s, false})};
}

// Rays at mirrored angles are computed by other roundings, and a ray that grazes an outline may then fall on its other
// side. One such ray is worth at most a quarter of a lamp at one pixel, less farther away; all in all it is nothing.
void expect_same_but_for_grazing(const ImageF& a, const ImageF& b, const std::string& what) {
    const double peak = largest(a);
    const Difference d = difference(a, b, 0.002 * peak);
    std::printf("%s: mean %.2e of the peak, %.3f %% of samples off by more than 0.2 %%, at most %.4f\n", what.c_str(), d.mean / peak,
                100 * d.share_above, d.max / peak);
    EXPECT_LE(d.mean, 2e-4 * peak) << what;
    EXPECT_LE(d.share_above, 0.01) << what;
}

class Symmetry : public testing::TestWithParam<std::pair<int, int>> {
protected:
    int width() const { return GetParam().first; }
    int height() const { return GetParam().second; }
    Point centre() const { return {0.5 * width() + 0.27, 0.5 * height() - 0.19}; }
    double unit() const { return 0.5 * std::min(width(), height()); }

    static ImageF rendered(int width, int height, std::vector<Shape> shapes, Quality quality) {
        Scene scene = rc_canvas(width, height);
        scene.sky.radiance = {0.01, 0.02, 0.03};
        scene.shapes = std::move(shapes);
        scene.render.quality = quality;
        return render_linear(scene);
    }
    std::string name(const char* what, Quality quality) const {
        return std::string(what) + " " + std::to_string(width()) + "x" + std::to_string(height()) + " quality " + std::to_string(int(quality));
    }
};

TEST_P(Symmetry, AMirroredSceneGivesTheMirroredPicture) {
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) {
        const ImageF plain = rendered(width(), height(), moved_shapes(centre(), unit(), {}), quality);
        Move move;
        move.mirrors = true;
        move.map = [&](Point p) { return Point(width() - p.x, p.y); };
        const ImageF mirror = rendered(width(), height(), moved_shapes(centre(), unit(), move), quality);
        expect_same_but_for_grazing(mirrored(plain), mirror, name("mirrored", quality));
        EXPECT_GT(difference(plain, mirror).mean, 1e-2) << "the scene must not be its own mirror image";
    }
}

TEST_P(Symmetry, AFlippedSceneGivesTheFlippedPicture) {
    const ImageF plain = rendered(width(), height(), moved_shapes(centre(), unit(), {}), Quality::standard);
    Move move;
    move.mirrors = true;
    move.map = [&](Point p) { return Point(p.x, height() - p.y); };
    const ImageF flip = rendered(width(), height(), moved_shapes(centre(), unit(), move), Quality::standard);
    expect_same_but_for_grazing(flipped(plain), flip, name("flipped", Quality::standard));
}

TEST_P(Symmetry, ATurnedSceneGivesTheTurnedPicture) {
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) {
        const ImageF plain = rendered(width(), height(), moved_shapes(centre(), unit(), {}), quality);
        Move move;
        move.turned_deg = 90;
        move.map = [&](Point p) { return Point(height() - p.y, p.x); };
        const ImageF turn = rendered(height(), width(), moved_shapes(centre(), unit(), move), quality);
        expect_same_but_for_grazing(turned(plain), turn, name("turned", quality));
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Symmetry, testing::Values(std::pair(64, 64), std::pair(61, 47), std::pair(37, 90)));

TEST(Translation, ByTheCoarsestSpacingMovesThePicture) {
    constexpr int kSide = 128;
    const auto rendered = [&](double dx, double dy) {
        Scene scene = rc_canvas(kSide, kSide);
        Move move;
        move.map = [&](Point p) { return p + Point(dx, dy); };
        scene.shapes = moved_shapes({60.3, 59.1}, 30, move);
        return render_linear(scene);
    };
    const double spacing = plan_cascades({kSide, kSide}, std::hypot(kSide, kSide), cascade_settings(Quality::standard)).back().spacing;
    ASSERT_EQ(spacing, 16);
    const ImageF plain = rendered(0, 0);
    const ImageF moved = rendered(16, -16);
    // Near the view's ends, light is interpolated from probes that are not there after the move: leave out as far as
    // the cascades' cells add up to, 2 + 4 + 8 + 16.
    constexpr int kEdge = 31;
    const int side = kSide - 2 * kEdge - 16;
    const ImageF a = crop(plain, kEdge, kEdge + 16, side, side);
    const ImageF b = crop(moved, kEdge + 16, kEdge, side, side);
    expect_same_but_for_grazing(a, b, "translated");
    EXPECT_GT(mean(a), 0.05);
}

TEST(Translation, OfViewAndSceneTogetherChangesNoByte) {
    const auto rendered = [](double dx, double dy) {
        Scene scene = rc_canvas(64, 48);
        Move move;
        move.map = [&](Point p) { return p + Point(dx, dy); };
        // Coordinates of a few binary digits, so that the sums are exact.
        scene.shapes = moved_shapes({32.25, 24.5}, 16, move);
        for (Shape& s : scene.shapes)
            if (auto* circle = std::get_if<Circle>(&s.geometry)) circle->center = Point(24.25 + dx, 20.5 + dy);
        scene.canvas.view = ViewRect{dx, dy, 64, 48};
        return render_linear(scene);
    };
    const ImageF at_origin = rendered(0, 0);
    EXPECT_GT(mean(at_origin), 0.05);
    // Shapes whose coordinates are no binary fractions lose the last digit of a double far away: 1e-10 of a pixel.
    expect_same_but_for_grazing(at_origin, rendered(1 << 20, -(1 << 20)), "view and scene moved");
    Scene near = with(rc_canvas(64, 48), {shape(Circle{{24.25, 20.5}, 4.5}, Colour(1)), shape(Rect{{40.5, 22.75}, {3, 20}, 0, 0})});
    Scene far = near;
    far.canvas.view = ViewRect{double(1 << 20), -double(1 << 20), 64, 48};
    std::get<Circle>(far.shapes[0].geometry).center += Point(1 << 20, -(1 << 20));
    std::get<Rect>(far.shapes[1].geometry).center += Point(1 << 20, -(1 << 20));
    EXPECT_EQ(render_linear(near).data, render_linear(far).data);
}

TEST(Scale, ASceneTenTimesAsLargeGivesTheSameBytes) {
    for (const double scale : {10.0, 0.125}) {
        Scene plain = rc_canvas(64, 48);
        plain.shapes = moved_shapes({32.25, 24.5}, 20, {});
        Move move;
        move.scale = scale;
        move.map = [&](Point p) { return scale * p; };
        Scene scaled = rc_canvas(64, 48);
        scaled.shapes = moved_shapes({32.25, 24.5}, 20, move);
        scaled.canvas.view = ViewRect{0, 0, 64 * scale, 48 * scale};
        EXPECT_GT(mean(render_linear(plain)), 0.05);
        EXPECT_EQ(render_display(plain).data, render_display(scaled).data) << scale;
    }
}

}  // namespace
}  // namespace penumbra::test
