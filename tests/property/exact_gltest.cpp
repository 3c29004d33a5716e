// SPDX-License-Identifier: MIT
// What must hold of light holds of the method `exact`, to the last digits that single precision has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core/plan/plan.h"
#include "core/plan/saving.h"
#include "core/reference/solver.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr Quality kQualities[] = {Quality::draft, Quality::standard, Quality::high};
constexpr std::pair<int, int> kSizes[] = {{1, 1}, {1, 90}, {113, 1}, {101, 37}, {16, 16}, {17, 33}};
constexpr double kPi = std::numbers::pi;

Scene exact(Scene scene, Quality quality = Quality::standard) {
    scene.render.method = "exact";
    scene.render.quality = quality;
    return scene;
}

// Lamps and walls of all types; `map` moves points.
std::vector<Shape> lamps_and_walls(Point centre, double unit, const std::function<Point(Point)>& map, double turned_deg = 0,
                                   bool mirrors = false, double scale = 1) {
    const auto at = [&](double x, double y) { return map(centre + unit * Point(x, y)); };
    const auto angle = [&](double degrees) { return (mirrors ? -degrees : degrees) + turned_deg; };
    const double s = unit * scale;
    return {shape(Circle{at(-0.42, -0.31), 0.11 * s}, {3, 2, 1}),
            shape(Circle{at(-0.33, -0.27), 0.09 * s}, {1, 2, 1}),
            shape(Rect{at(0.13, 0.05), {0.11 * s, 0.7 * s}, angle(12), 0.02 * s}),
            shape(Ellipse{at(0.52, 0.33), {0.17 * s, 0.08 * s}, angle(40)}, {0, 0.5, 2}),
            shape(Line{at(-0.3, 0.42), at(-0.1, 0.57), 0.05 * s}, {0.3, 0.3, 0}),
            shape(Polygon{{at(-0.7, 0.2), at(-0.55, 0.28), at(-0.66, 0.5)}}),
            shape(Polyline{{at(0.4, -0.6), at(0.65, -0.45), at(0.45, -0.25)}, 0.06 * s, false})};
}
Point same(Point p) { return p; }

Scene test_scene(int width = 96, int height = 70, Quality quality = Quality::standard) {
    Scene scene = exact(canvas(width, height), quality);
    scene.sky.radiance = {0.01, 0.02, 0.03};
    scene.shapes = lamps_and_walls({0.5 * width + 0.27, 0.5 * height - 0.19}, 0.5 * std::min(width, height), same);
    return scene;
}

// Mean relative difference, a twentieth of the mean added to what it is relative to; solid pixels left out.
double off_by(const ImageF& a, const ImageF& b) {
    double mean_b = 0, sum = 0;
    std::size_t count = 0;
    for (const float v : b.data)
        if (std::isfinite(v)) mean_b += v, ++count;
    mean_b /= double(count);
    for (std::size_t i = 0; i < a.data.size(); ++i)
        if (std::isfinite(b.data[i])) sum += std::abs(double(a.data[i]) - b.data[i]) / (b.data[i] + 0.05 * mean_b);
    return sum / double(count);
}

// ---- furnaces ----

TEST(ExactSky, UniformIsItselfAtAnySizeQualityAndMargin) {
    const Colour sky(0.3, 1.7, 1234.5);
    for (const auto& [width, height] : kSizes)
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 0.37, 25.0}) {
                Scene scene = exact(canvas(width, height), quality);
                scene.sky.radiance = sky;
                scene.canvas.margin = margin;
                const ImageF picture = render_linear(scene);
                for (std::size_t i = 0; i < picture.data.size(); ++i) {
                    const double wanted = sky[static_cast<int>(i % 3)];
                    ASSERT_NEAR(picture.data[i], wanted, 2e-6 * wanted) << width << "x" << height << " margin " << margin;
                }
            }
}

TEST(ExactSky, AnEmptySceneHasTheMeanOfAGradient) {
    // Trapezoids between 20, 100, 230 and 380 degrees.
    const Colour mean = (80.0 * Colour(0.5, 1, 0) + 130.0 * Colour(2.5, 2.5, 3) + 150.0 * Colour(0.5, 0, 0.5)) / 360.0;
    for (const auto& [width, height] : kSizes)
        for (const Quality quality : kQualities) {
            Scene scene = exact(canvas(width, height), quality);
            scene.sky.gradient = {{20, {1, 0, 0}}, {100, {0, 2, 0}}, {100, {5, 5, 5}}, {230, {0, 0, 1}}};
            const ImageF picture = render_linear(scene);
            for (std::size_t i = 0; i < picture.data.size(); ++i)
                ASSERT_NEAR(picture.data[i], mean[static_cast<int>(i % 3)], 1e-5) << width << "x" << height;
        }
}

TEST(ExactFurnace, EveryFreePixelHasTheOneRadiance) {
    for (const auto& [width, height] : {std::pair(64, 48), std::pair(101, 37), std::pair(1, 90), std::pair(113, 1)})
        for (const Quality quality : kQualities)
            for (const double margin : {0.0, 11.3}) {
                Scene scene = exact(canvas(width, height), quality);
                scene.shapes = lamps_and_walls({0.5 * width, 0.5 * height}, 30, same);
                scene.shapes.push_back(shape(Bitmap{picture(4, 4, [](int x, int y) { return (x + y) % 2 == 0; }), {3.3, 4.1}, {8, 8}, 2.0, 0.5, false}));
                for (Shape& s : scene.shapes) s.emission = Colour(2);
                scene.sky.radiance = Colour(2);
                scene.canvas.margin = margin;
                for (const float value : render_linear(scene).data) ASSERT_NEAR(value, 2, 4e-6) << width << " " << int(quality);
            }
}

// ---- closed forms ----

struct Errors {
    double mean = 0, most = 0;  // relative
};

// Over the pixels where `wanted` is positive.
Errors against(const Scene& scene, const std::function<double(Point)>& wanted) {
    const ImageF picture = render_linear(scene);
    Errors e;
    int count = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const double truth = wanted({x + 0.5, y + 0.5});
            if (truth <= 0) continue;
            const double off = std::abs(double(picture.at(x, y)[1]) / truth - 1);
            e.mean += off;
            e.most = std::max(e.most, off);
            ++count;
        }
    e.mean /= count;
    return e;
}

// Of one quality: bounds on the mean and the largest relative error.
struct Bound {
    Quality quality;
    double mean, most;
};

void expect_form(const char* what, const Scene& scene, const std::function<double(Point)>& wanted, std::initializer_list<Bound> bounds) {
    for (const Bound& bound : bounds) {
        const Errors e = against(exact(scene, bound.quality), wanted);
        std::printf("%s, quality %d: mean %.2e, most %.2e\n", what, int(bound.quality), e.mean, e.most);
        EXPECT_LE(e.mean, bound.mean) << what;
        EXPECT_LE(e.most, bound.most) << what;
    }
}

TEST(ExactClosedForm, ADiscInTheOpen) {
    for (const Point centre : {Point(64, 64), Point(61.3, 70.8)}) {
        const Scene scene = with(canvas(128, 128), {shape(Circle{centre, 10}, Colour(1))});
        const auto wanted = [&](Point p) {
            const double r = std::hypot(p.x - centre.x, p.y - centre.y);
            return r > 10.01 ? std::asin(10 / r) / kPi : 0.0;
        };
        expect_form("disc", scene, wanted, {{Quality::draft, 3e-4, 5e-3}, {Quality::standard, 1.5e-4, 2e-3}, {Quality::high, 4e-5, 4e-4}});
    }
}

TEST(ExactClosedForm, ALongWallThatShines) {
    // The wall runs through all of the domain, which ends it.
    constexpr double kMargin = 500, kWidth = 80, kFace = 50.3;
    Scene scene = with(canvas(80, 48), {shape(Rect{{40, kFace + 5}, {4000, 10}, 0, 0}, Colour(1))});
    scene.canvas.margin = kMargin;
    const auto wanted = [&](Point p) {
        const double d = kFace - p.y;
        return (std::atan((kWidth + kMargin - p.x) / d) + std::atan((p.x + kMargin) / d)) / (2 * kPi);
    };
    expect_form("wall", scene, wanted, {{Quality::draft, 5e-7, 2e-6}, {Quality::standard, 5e-7, 2e-6}, {Quality::high, 5e-7, 2e-6}});
}

// The directions from p to a rect, its middle straight above p or not, as angles from straight up.
std::pair<double, double> span_of(const Rect& rect, Point p) {
    std::pair<double, double> span(10, -10);
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5}) {
            const Point corner = rect.center + Point(x, y) * Point(rect.size);
            const double angle = std::atan2(corner.x - p.x, p.y - corner.y);
            span = {std::min(span.first, angle), std::max(span.second, angle)};
        }
    return span;
}

TEST(ExactClosedForm, ASegmentBetween) {
    const Rect lamp{{50.2, 4}, {24, 2}, 0, 0};
    const Rect wall{{46.7, 22}, {13, 0.02}, 0, 0};
    const Scene scene = with(canvas(100, 90), {shape(lamp, Colour(1)), shape(wall)});
    const auto wanted = [&](Point p) {
        if (p.y < 24) return 0.0;
        const auto [lamp_from, lamp_to] = span_of(lamp, p);
        const auto [wall_from, wall_to] = span_of(wall, p);
        const double hidden = std::max(0.0, std::min(lamp_to, wall_to) - std::max(lamp_from, wall_from));
        return (lamp_to - lamp_from - hidden) / (2 * kPi);
    };
    expect_form("segment between", scene, wanted, {{Quality::draft, 3e-3, 0.08}, {Quality::standard, 5e-4, 0.02}, {Quality::high, 1e-4, 3e-3}});
}

TEST(ExactClosedForm, ClosedWallsKeepTheLight) {
    for (const double wall : {0.05, 1.0, 4.0})
        for (const Quality quality : kQualities) {
            const Scene scene = with(exact(canvas(96, 96), quality),
                                     {shape(Circle{{46.3, 49.2}, 5}, Colour(1)),
                                      shape(Polyline{{{26.4, 27.3}, {68.2, 25.1}, {70.6, 66.4}, {24.3, 69.7}}, wall, true})});
            const ImageF picture = render_linear(scene);
            EXPECT_GT(picture.at(46, 38)[0], 0.1);
            for (int y = 0; y < 96; ++y)
                for (int x = 0; x < 96; ++x) {
                    if (x > 19 && x < 76 && y > 20 && y < 75) continue;  // the box and its walls
                    ASSERT_EQ(picture.at(x, y)[0], 0) << x << ", " << y << " wall " << wall;
                }
        }
}

// ---- symmetry ----

TEST(ExactSymmetry, MirroredFlippedAndTurnedScenesGiveSuchPictures) {
    // Cells start at the top left, so between their corners the pictures differ by what the tolerance allows.
    for (const auto& [w, h] : {std::pair(64, 64), std::pair(61, 47), std::pair(37, 90)})
        for (const auto& [quality, bound] : {std::pair(Quality::draft, 4e-3), std::pair(Quality::standard, 6e-4), std::pair(Quality::high, 5e-5)}) {
            const int width = w;
            const int height = h;
            const auto rendered = [&](int wide, int high, const std::function<Point(Point)>& map, double turned_deg, bool mirrors) {
                Scene scene = exact(canvas(wide, high), quality);
                scene.sky.radiance = {0.01, 0.02, 0.03};
                scene.shapes = lamps_and_walls({0.5 * width + 0.27, 0.5 * height - 0.19}, 0.5 * std::min(width, height), map, turned_deg, mirrors);
                return render_linear(scene);
            };
            const ImageF plain = rendered(width, height, same, 0, false);
            const ImageF mirror = rendered(width, height, [&](Point p) { return Point(width - p.x, p.y); }, 0, true);
            const ImageF flip = rendered(width, height, [&](Point p) { return Point(p.x, height - p.y); }, 0, true);
            const ImageF turn = rendered(height, width, [&](Point p) { return Point(height - p.y, p.x); }, 90, false);
            const double off[] = {off_by(mirror, mirrored(plain)), off_by(flip, flipped(plain)), off_by(turn, turned(plain))};
            std::printf("%dx%d quality %d: mirrored %.2e, flipped %.2e, turned %.2e\n", width, height, int(quality), off[0], off[1], off[2]);
            for (const double o : off) EXPECT_LE(o, bound) << width << "x" << height << " " << int(quality);
            EXPECT_GT(off_by(mirror, plain), 0.1) << "the scene must not be its own mirror image";
        }
}

TEST(ExactTranslation, ByFractionsOfAPixelStaysAtTheTruth) {
    for (const auto& [quality, bound] : {std::pair(Quality::draft, 4.5e-3), std::pair(Quality::standard, 6e-4), std::pair(Quality::high, 7e-5)})
        for (const Point by : {Point(0.125, 0), Point(0.31, -0.47), Point(0.5, 0.5), Point(-3.77, 5.99)}) {
            Scene scene = test_scene(72, 56, quality);
            scene.shapes = lamps_and_walls(Point(36.27, 27.81), 28, [&](Point p) { return p + by; });
            const double off = off_by(render_linear(scene), reference::solve(scene).image);
            std::printf("quality %d, by %g, %g: %.2e\n", int(quality), by.x, by.y, off);
            EXPECT_LE(off, bound);
        }
}

TEST(ExactView, FarOffsetsAndOtherScalesGiveTheSamePicture) {
    const Scene plain = test_scene();
    const ImageF picture = render_linear(plain);
    const double peak = largest(picture);
    for (const auto& [offset, scale] : {std::pair(Point(1e6, -1e6), 1.0), std::pair(Point(0), 1e-3), std::pair(Point(0), 1e6),
                                        std::pair(Point(-7e5, 3e5), 1e-3), std::pair(Point(1e6, 1e6), 100.0)}) {
        Scene moved = plain;
        moved.shapes = lamps_and_walls({48.27, 34.81}, 35, [&, o = offset, s = scale](Point p) { return s * p + o; }, 0, false, scale);
        moved.canvas.view = ViewRect{offset.x, offset.y, 96 * scale, 70 * scale};
        const Difference d = difference(render_linear(moved), picture);
        std::printf("offset %g, scale %g: max %.2e, mean %.2e of the peak\n", offset.x, scale, d.max / peak, d.mean / peak);
        // At 1e6 pixels of a thousandth of a unit, a double's last digit is 1e-7 px.
        EXPECT_LE(d.mean, 1e-6 * peak) << offset.x << " " << scale;
        EXPECT_LE(d.max, 1e-3 * peak) << offset.x << " " << scale;
    }
}

// ---- light ----

TEST(ExactLight, DoubledDoublesEveryValueExactlyAndChannelsKeepApart) {
    for (const Quality quality : kQualities) {
        Scene scene = test_scene(72, 56, quality);
        const ImageF once = render_linear(scene);
        Scene twice = scene, swapped = scene;
        const auto swap = [](Colour c) { return Colour(c.b, c.r, c.g); };
        for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
            twice.shapes[i].emission *= 2;
            swapped.shapes[i].emission = swap(scene.shapes[i].emission);
        }
        twice.sky.radiance *= 2;
        swapped.sky.radiance = swap(scene.sky.radiance);
        const ImageF doubled = render_linear(twice), turned_colours = render_linear(swapped);
        for (std::size_t i = 0; i < once.data.size(); ++i) {
            ASSERT_EQ(doubled.data[i], 2 * once.data[i]);
            ASSERT_EQ(turned_colours.data[i], once.data[i / 3 * 3 + (i + 2) % 3]);
        }
    }
}

// ---- the same bytes ----

// Cells are not among it: what they leave out is interpolated (skip_gltest.cpp bounds it).
TEST(ExactBytes, SkippingAllButCellsChangesNone) {
    Scene sky = exact(canvas(37, 29));
    sky.sky.radiance = {0.3, 0.5, 0.7};
    const Shape dark = shape(Circle{{11.3, 14.2}, 5.1});
    for (Scene scene : {exact(canvas(37, 29)), sky, with(exact(canvas(37, 29)), {dark}), with(sky, {dark}), test_scene()}) {
        scene.render.skip = Skip::none;
        EXPECT_TRUE(make_plan(scene, {}).skipped.empty());
        scene.render.skip = Skip::all;
        const ImageF skipped = render_linear(scene);
        for (const SavingName& one : kSavings) {
            if (one.saving == Saving::cells || one.saving == Saving::constant) continue;
            scene.render.keep = std::uint32_t(one.saving);
            EXPECT_EQ(render_linear(scene).data, skipped.data) << one.name;
        }
    }
}

// As a GPU solves: a thread takes some sectors of one point, in another order of sums.
TEST(ExactLanes, ShareTheSectorsAndAddUp) {
    RendererOptions options = test_options();
    options.solver_lanes = 4;
    Renderer four(options);
    options.solver_lanes = 1;
    Renderer one(options);
    Scene bouncing = test_scene(61, 47);
    for (Shape& each : bouncing.shapes) each.albedo = Colour(0.5);
    bouncing.render.bounces = 2;
    Scene gradient = test_scene(83, 33, Quality::high);
    gradient.sky.gradient = {{0, Colour(0.1)}, {120, Colour(0.5, 0.2, 0)}, {300, Colour(0, 0.1, 0.4)}};
    for (const Scene& scene : {test_scene(), test_scene(33, 90, Quality::draft), gradient, bouncing, test_scene(1, 1)}) {
        const ImageF a = std::get<ImageF>(four.render(scene).picture), b = std::get<ImageF>(one.render(scene).picture);
        const double floor = 1e-6 * mean(b);
        for (std::size_t i = 0; i < a.data.size(); ++i) ASSERT_NEAR(a.data[i], b.data[i], 4e-6 * b.data[i] + 2 * floor) << i;
        EXPECT_EQ(std::get<ImageF>(four.render(scene).picture).data, a.data) << "twice";
    }
}

// Nothing waits for what lists took; when it was more than they had room for, the frame is made again.
TEST(ExactLanes, ListsThatDidNotFitAreMadeAgain) {
    RendererOptions options = test_options();
    options.solver_lanes = 8;
    Renderer eight(options);
    options.solver_lanes = 1;
    Renderer one(options);
    Scene scene = exact(canvas(120, 120));
    for (int i = 0; i < 576; ++i) {
        const Point at(5.0 * (i % 24) + 2.2 + 0.3 * (i % 7), 5.0 * (i / 24) + 2.3 + 0.2 * (i % 5));
        scene.shapes.push_back(shape(Circle{at, 0.3}, i % 3 == 0 ? Colour(1, 0.5, 0.2) : Colour(0)));
    }
    const RenderResult first = eight.render(scene), second = eight.render(scene);
    const auto lists = [](const RenderStats& stats) {
        for (const PassStats& pass : stats.passes)
            if (pass.name == "exact lists") return pass.dispatches;
        return std::uint64_t(0);
    };
    EXPECT_GT(lists(first.stats), lists(second.stats)) << "the first frame did fit: the test tells nothing";
    const ImageF a = std::get<ImageF>(first.picture), b = std::get<ImageF>(one.render(scene).picture);
    EXPECT_EQ(std::get<ImageF>(second.picture).data, a.data);
    const double floor = 1e-6 * mean(b);
    for (std::size_t i = 0; i < a.data.size(); ++i) ASSERT_NEAR(a.data[i], b.data[i], 1e-5 * b.data[i] + floor) << i;
}

TEST(ExactBytes, RendersAreRepeatableWhateverWasRenderedBefore) {
    Scene other = test_scene(300, 211, Quality::high);
    other.sky.gradient = {{0, Colour(0)}, {90, Colour(3)}};
    Numbers numbers(7);
    for (int i = 0; i < 200; ++i)
        other.shapes.push_back(shape(Circle{{numbers.between(0, 300), numbers.between(0, 211)}, numbers.between(0.2, 3)}, Colour(i % 3 == 0 ? 1.0 : 0.0)));
    Scene small = with(exact(canvas(20, 20)), {shape(Circle{{4, 5}, 2}, Colour(9))});
    for (const Quality quality : kQualities) {
        const Scene scene = test_scene(96, 70, quality);
        Renderer fresh(test_options());
        const ImageF first = std::get<ImageF>(fresh.render(scene).picture);
        const auto again = [&] { return std::get<ImageF>(fresh.render(scene).picture); };
        EXPECT_EQ(again().data, first.data) << "twice";
        fresh.render(small);
        EXPECT_EQ(again().data, first.data) << "after a smaller one";
        fresh.render(other);
        EXPECT_EQ(again().data, first.data) << "after a larger one, buffers reused";
        Scene same_size = other;
        same_size.canvas.width = 96;
        same_size.canvas.height = 70;
        fresh.render(same_size);
        EXPECT_EQ(again().data, first.data) << "after one of the same size, textures reused";
        for (const char* method : {"rc", "hrc"}) {
            same_size.render.method = method;
            fresh.render(same_size);
            EXPECT_EQ(again().data, first.data) << "after " << method;
        }
    }
}

// ---- large pictures ----

// Pixels here and there, and all along these rows.
void expect_truth_at(const Scene& scene, int samples, const std::vector<int>& rows, double bound) {
    const ImageF picture = render_linear(scene);
    reference::ExactSolver solver(scene);
    Numbers numbers(3);
    double sum = 0, mean = 0;
    int count = 0;
    const auto check = [&](int x, int y) {
        const Point p = scene.canvas.view_or_default().x + scene.canvas.pixel_size() * Point(x + 0.5, y + 0.5);
        if (solver.is_solid(p)) return;
        const double truth = solver.value(p).g;
        sum += std::abs(double(picture.at(x, y)[1]) - truth);
        mean += truth;
        ++count;
    };
    for (int i = 0; i < samples; ++i)
        check(static_cast<int>(numbers.between(0, picture.width)), static_cast<int>(numbers.between(0, picture.height)));
    for (const int row : rows)
        for (int i = 0; i < 200; ++i) check(static_cast<int>(numbers.between(0, picture.width)), row);
    std::printf("%dx%d: off by %.2e of the mean\n", picture.width, picture.height, sum / mean);
    EXPECT_GT(count, samples / 2);
    EXPECT_LE(sum / mean, bound);
}

TEST(ExactLarge, ALongStrip) {
    Scene tall = with(exact(canvas(8, 4096)), {shape(Circle{{4, 700}, 2}, Colour(5)), shape(Rect{{1, 800}, {3, 2}, 10, 0}), shape(Circle{{-3, 3000}, 6}, Colour(2))});
    tall.canvas.margin = 20;
    expect_truth_at(tall, 400, {4080, 4095}, 3e-4);
    Scene wide = with(exact(canvas(4096, 5)), {shape(Circle{{1700, 2}, 1}, Colour(5)), shape(Rect{{800, 1}, {3, 2}, 10, 0})});
    expect_truth_at(wide, 400, {0, 4}, 3e-4);
}

TEST(ExactLarge, InBands) {
    Scene scene = exact(canvas(4096, 530));
    scene.shapes = {shape(Circle{{1000, 460}, 20}, {1, 5, 2}), shape(Rect{{1200, 512}, {30, 60}, 20, 0}), shape(Circle{{2500, 525}, 6}, {3, 4, 2}),
                    shape(Line{{2300, 490}, {2450, 520}, 3})};
    const int band = make_plan(scene, shared_renderer().device().kind == "cpu" ? DeviceLimits{} : DeviceLimits{.software = false}).exact.band_rows;
    if (shared_renderer().device().kind == "cpu") {
        EXPECT_LT(band, 530) << "one band proves nothing";
    }
    expect_truth_at(scene, 400, {std::min(band - 1, 528), std::min(band, 529), std::min(band + 1, 529), 529}, 3e-4);
}

}  // namespace
}  // namespace penumbra::test
