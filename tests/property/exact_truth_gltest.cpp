// SPDX-License-Identifier: MIT
// The method `exact` against the exact solver on the processor: small random scenes of everything that a scene may hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/compare/error_figures.h"
#include "core/device_error.h"
#include "core/plan/plan.h"
#include "core/reference/solver.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

Scene exact(Scene scene, Quality quality) {
    scene.render.method = "exact";
    scene.render.quality = quality;
    return scene;
}

Point somewhere(Numbers& numbers, double beyond = 6) {
    return {numbers.between(-beyond, kWidth + beyond), numbers.between(-beyond, kHeight + beyond)};
}

Colour light_of(Numbers& numbers, double share) {
    if (numbers.next() >= share) return Colour(0);
    return {numbers.between(0, 3), numbers.between(0, 3), numbers.between(0, 3)};
}

// Any of the seven types, of about this size.
Geometry any_geometry(Numbers& numbers, Point at, double size) {
    const auto off = [&] { return Point(numbers.between(-size, size), numbers.between(-size, size)); };
    const double angle = numbers.between(0, 360);
    switch (static_cast<int>(numbers.between(0, 7))) {
        case 0: return Circle{at, size};
        case 1: return Ellipse{at, {size, size * numbers.between(0.2, 0.9)}, angle};
        case 2: {
            const double high = size * numbers.between(0.2, 2);
            return Rect{at, {2 * size, high}, angle, numbers.next() < 0.5 ? 0 : numbers.between(0, 0.5) * std::min(2 * size, high)};
        }
        case 3: return Line{at, at + off() + off(), size * numbers.between(0.1, 0.6)};
        case 4: return Polyline{{at, at + off(), at + off(), at + off()}, size * numbers.between(0.1, 0.4), numbers.next() < 0.3};
        case 5: {
            std::vector<Point> points;
            for (int i = 0; i < 3 + static_cast<int>(numbers.between(0, 4)); ++i) points.push_back(at + off() + 0.3 * off());
            return Polygon{points};
        }
        default: {
            const int modulus = 2 + static_cast<int>(numbers.between(0, 3));
            return Bitmap{picture(5, 4, [&](int x, int y) { return (3 * x + 2 * y) % modulus != 0; }), at, {1.25 * size, size}, 1.0, 0.5,
                          numbers.next() < 0.5};
        }
    }
}

void scatter(Scene& scene, Numbers& numbers, int count, double least, double most, double lit) {
    for (int i = 0; i < count; ++i) {
        const double size = least * std::pow(most / least, numbers.next());
        scene.shapes.push_back(shape(any_geometry(numbers, somewhere(numbers), size), light_of(numbers, lit)));
    }
}

Sky gradient(Numbers& numbers) {
    Sky sky;
    double angle = numbers.between(0, 40);
    for (int i = 0; i < 5; ++i) {
        sky.gradient.push_back({angle, light_of(numbers, 0.8)});
        if (i == 2) sky.gradient.push_back({angle, light_of(numbers, 0.8)});  // a step
        angle += numbers.between(10, 60);
    }
    return sky;
}

struct Theme {
    const char* name;
    void (*fill)(Scene&, Numbers&);
};

const std::array<Theme, 10> kThemes = {{
    {"scattered", [](Scene& s, Numbers& n) { scatter(s, n, 7, 1, 8, 0.4); }},
    {"overlapping",
     [](Scene& s, Numbers& n) {
         for (int i = 0; i < 9; ++i) s.shapes.push_back(shape(any_geometry(n, {n.between(20, 44), n.between(14, 34)}, n.between(3, 9)), light_of(n, 0.5)));
     }},
    {"nested",
     [](Scene& s, Numbers& n) {
         // Larger ones on top hide smaller ones, and smaller ones on top of larger ones show nothing.
         const Point at{n.between(20, 44), n.between(16, 32)};
         for (const double radius : {3.0, 9.0, 6.0, 2.0}) s.shapes.push_back(shape(Circle{at, radius}, light_of(n, 0.7)));
         for (const double side : {4.0, 7.0}) s.shapes.push_back(shape(Rect{{8, 40}, {side, side}, 0, 0}, light_of(n, 0.7)));
         scatter(s, n, 4, 1, 4, 0.2);
     }},
    {"touching",
     [](Scene& s, Numbers& n) {
         // Rects that share edges and corners, discs that touch, a disc on an edge.
         const Point at{std::floor(n.between(10, 30)) + 0.25, std::floor(n.between(8, 24)) + 0.25};
         s.shapes.push_back(shape(Rect{at, {6, 4}, 0, 0}, light_of(n, 0.5)));
         s.shapes.push_back(shape(Rect{at + Point(5, 0), {4, 4}, 0, 0}, light_of(n, 0.5)));
         s.shapes.push_back(shape(Rect{at + Point(9, 4), {4, 4}, 0, 0}, light_of(n, 0.5)));
         s.shapes.push_back(shape(Circle{at + Point(0, 5), 3}, light_of(n, 0.5)));
         s.shapes.push_back(shape(Circle{at + Point(5, 5), 2}, light_of(n, 0.5)));
         s.shapes.push_back(shape(Polygon{{at + Point(7, 2), at + Point(7, 12), at + Point(2, 12)}}, light_of(n, 0.5)));
         scatter(s, n, 2, 1, 3, 1);
     }},
    {"strokes",
     [](Scene& s, Numbers& n) {
         for (int i = 0; i < 6; ++i) {
             const Point at = somewhere(n, 0);
             s.shapes.push_back(shape(Polyline{{at, somewhere(n), somewhere(n)}, n.between(0.1, 0.6), n.next() < 0.3}, light_of(n, 0.3)));
         }
         s.shapes.push_back(shape(Circle{somewhere(n, 0), 2.5}, Colour(2, 1, 3)));
     }},
    {"tiny lamps",
     [](Scene& s, Numbers& n) {
         for (int i = 0; i < 6; ++i) s.shapes.push_back(shape(Circle{somewhere(n, 0), n.between(0.05, 0.6)}, light_of(n, 1) * 4.0));
         scatter(s, n, 6, 1, 6, 0);
     }},
    {"constant sky",
     [](Scene& s, Numbers& n) {
         s.sky.radiance = light_of(n, 1);
         scatter(s, n, 7, 1, 7, 0.3);
     }},
    {"gradient sky",
     [](Scene& s, Numbers& n) {
         s.sky = gradient(n);
         scatter(s, n, 6, 1, 7, 0.2);
     }},
    {"margin",
     [](Scene& s, Numbers& n) {
         s.canvas.margin = n.between(3, 40);
         for (int i = 0; i < 8; ++i) s.shapes.push_back(shape(any_geometry(n, somewhere(n, 36), n.between(2, 7)), light_of(n, 0.4)));
         if (n.next() < 0.5) s.sky = gradient(n);
     }},
    {"many",
     [](Scene& s, Numbers& n) {
         scatter(s, n, 70, 0.3, 1.5, 0.2);
         if (n.next() < 0.5) s.sky.radiance = Colour(0.1, 0.2, 0.05);
     }},
}};

Scene random_scene(std::size_t theme, int turn) {
    Numbers numbers(1000 * theme + static_cast<std::uint64_t>(turn) + 17);
    Scene scene = canvas(kWidth, kHeight);
    kThemes[theme].fill(scene, numbers);
    return scene;
}

constexpr int kTurns = 4;  // of each theme

const ImageF& truth_of(std::size_t theme, int turn) {
    static std::map<std::pair<std::size_t, int>, ImageF> solved;
    const auto [found, is_new] = solved.try_emplace({theme, turn});
    if (is_new) {
        reference::Solution solution = reference::solve(random_scene(theme, turn));
        if (!solution.problems.empty()) throw std::logic_error(solution.problems.front().message);
        found->second = std::move(solution.image);
    }
    return found->second;
}

struct Bounds {
    Quality quality;
    // Of one scene. What counts as dark for the leak is below a millionth of the mean, and may honestly be lit that much.
    double rel, max, bias, leak;
    double mean_rel;              // over all scenes
};

std::ostream& operator<<(std::ostream& out, const Bounds& b) { return out << "quality " << int(b.quality); }

class ExactTruth : public testing::TestWithParam<Bounds> {};

TEST_P(ExactTruth, RandomScenesStayNear) {
    const Bounds& bound = GetParam();
    double sum = 0;
    for (std::size_t theme = 0; theme < kThemes.size(); ++theme)
        for (int turn = 0; turn < kTurns; ++turn) {
            const ImageF picture = render_linear(exact(random_scene(theme, turn), bound.quality));
            const auto figures = error_figures(picture, truth_of(theme, turn));
            const ErrorFigures& e = std::get<ErrorFigures>(figures);
            const std::string name = std::string(kThemes[theme].name) + " " + std::to_string(turn);
            std::printf("%-16s quality %d: rel %.2e max %.2e bias %+.2e leak %.2e\n", name.c_str(), int(bound.quality), e.rel.value_or(0),
                        e.max.value_or(0), e.bias.value_or(0), e.leak.value_or(0));
            EXPECT_GT(e.count, 0u) << name;
            EXPECT_EQ(e.nan_only_a, 0u) << name;
            EXPECT_LE(e.rel.value_or(0), bound.rel) << name;
            EXPECT_LE(e.max.value_or(0), bound.max) << name;
            EXPECT_LE(std::abs(e.bias.value_or(0)), bound.bias) << name;
            EXPECT_LE(e.leak.value_or(0), bound.leak) << name;
            sum += e.rel.value_or(0);
        }
    const double mean_rel = sum / double(kThemes.size() * kTurns);
    std::printf("quality %d: mean rel %.2e\n", int(bound.quality), mean_rel);
    EXPECT_LE(mean_rel, bound.mean_rel);
}

// From measurement on llvmpipe, half as much again.
INSTANTIATE_TEST_SUITE_P(Qualities, ExactTruth,
                         testing::Values(Bounds{Quality::draft, 5e-3, 1, 1.5e-3, 1e-5, 1.4e-3}, Bounds{Quality::standard, 9e-4, 0.08, 2e-4, 1e-8, 1.8e-4},
                                         Bounds{Quality::high, 1.1e-4, 0.008, 2e-5, 1e-8, 8e-6}));

// ---- lists that are long ----

// The mean relative error of `exact` against the solver at every third pixel.
double strided_error(Scene scene) {
    scene.render.method = "exact";
    reference::SolveOptions options;
    options.stride = 3;
    const reference::Solution solution = reference::solve(scene, options);
    const auto figures = error_figures(render_linear(scene), solution.image);
    const ErrorFigures& e = std::get<ErrorFigures>(figures);
    std::printf("%zu pieces: rel %.2e max %.2e\n", solution.pieces, *e.rel, *e.max);
    return *e.rel;
}

// Far away and all in one sector of direction: more pieces than a list's head can count.
Scene far_crowd(bool arcs, int count) {
    Scene scene = canvas(16, 16);
    scene.canvas.margin = 120;
    scene.sky.radiance = Colour(0.5);
    for (int i = 0; i < count; ++i) {
        const Point at{108 + 0.033 * (i % 7), 16.7 + 0.005 * i};
        const Colour light(i % 2 == 0 ? 1.0 : 0.0);
        if (arcs) scene.shapes.push_back(shape(Circle{at, 0.02}, light));
        else scene.shapes.push_back(shape(Ellipse{at, {0.0024, 0.0017}, 30}, light));
    }
    return scene;
}

TEST(ExactMany, ListsTooLongToCountAreRefusedNotWrong) {
    for (const bool arcs : {false, true}) {
        EXPECT_LE(strided_error(far_crowd(arcs, 20)), 1e-5);
        Scene scene = far_crowd(arcs, 260);
        scene.render.method = "exact";
        EXPECT_THROW(shared_renderer().render(scene), DeviceError);
    }
}

// A crowd in one sector of direction, whose walk takes more than a dispatch's iterations, and more sectors after it.
TEST(ExactMany, ASectorThatIsCutOffIsRefusedNotWrong) {
    Scene scene = canvas(16, 16);
    scene.canvas.margin = 320;
    scene.sky.radiance = Colour(0.1);
    for (int i = 0; i < 400; ++i) scene.shapes.push_back(shape(Circle{{-290 - 0.3 * (i % 5), -1 + 0.045 * i}, 0.03}, Colour(i % 2 == 0 ? 3.0 : 0.0)));
    try {
        EXPECT_LE(strided_error(scene), 1e-3);
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("too dense"), std::string::npos) << error.what();
    }
}

// Between two walls, few points see many small discs far away: the survey does not notice.
TEST(ExactMany, AutoTakesAnotherMethodWhereASceneIsTooDense) {
    Scene scene = canvas(512, 512);
    scene.sky.radiance = Colour(0.1);
    for (int i = 0; i < 140; ++i) scene.shapes.push_back(shape(Circle{{480, 226 + 0.43 * i}, 0.15}));
    scene.shapes.push_back(shape(Rect{{300, 216}, {400, 3}, 0, 0}));
    scene.shapes.push_back(shape(Rect{{300, 296}, {400, 3}, 0, 0}));
    scene.shapes.push_back(shape(Circle{{500, 256}, 10}, Colour(1)));
    scene.render.method = "exact";
    EXPECT_THROW(shared_renderer().render(scene), DeviceError);
    scene.render.method = "auto";
    ASSERT_EQ(make_plan(scene, {}).method, "exact") << "the survey notices: this test needs another scene";
    const RenderResult result = shared_renderer().render(scene);
    EXPECT_EQ(result.stats.method, "hrc");
    EXPECT_NE(result.stats.method_reason.find("too dense"), std::string::npos) << result.stats.method_reason;
    scene.render.method = "hrc";
    EXPECT_EQ(render_linear(scene).data, std::get<ImageF>(result.picture).data);
}

TEST(ExactMany, StrokesOfManyPieces) {
    Scene scene = canvas(160, 120);
    Numbers numbers(2);
    for (int k = 0; k < 8; ++k) {
        std::vector<Point> points;
        for (int i = 0; i < 40; ++i) points.push_back({20.0 + 3 * i + numbers.between(-1, 1), 15.0 * k + 8 * std::sin(0.3 * i) + numbers.between(-1, 1)});
        scene.shapes.push_back(shape(Polyline{points, 0.8, false}, Colour(k % 3 == 0 ? 1.0 : 0.0)));
    }
    EXPECT_LE(strided_error(scene), 1e-4);
}

}  // namespace
}  // namespace penumbra::test
