// SPDX-License-Identifier: MIT
// Radiance of any size, shapes of no size, canvases of any shape, numbers far from the origin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/device_error.h"
#include "tests/stability/judge.h"
#include "tests/stability/ledger.h"
#include "tests/stability/scenes.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

template <class... T>
std::string text(const T&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

void judge(const std::string& law, const Scene& scene, const std::string& name, const std::vector<Way>& ways) {
    const ImageF truth = truth_of(scene);
    for (const Way& way : ways) {
        const ImageF picture = render_linear(as(scene, way));
        EXPECT_EQ(impossible(scene, picture), "") << to_string(way) << ", " << name;
        const Off off = off_by(scene, picture, truth);
        hold(law, way, "rel", off.rel, name);
        hold(law, way, "mean of peak", off.of_peak, name);
    }
}

// ---- range ----

TEST(Range, FromAMillionthToAMillionInOneScene) {
    // Two rooms with a wall between: what shines in one must not drown in the other's digits.
    Scene scene = with(canvas(64, 40), {shape(Rect{{32, 20}, {3, 60}, 0, 0}), shape(Circle{{16.3, 20.2}, 4}, Colour(1e6)),
                                        shape(Circle{{48.3, 19.7}, 4}, Colour(1e-6, 2e-6, 3e-6))});
    const ImageF truth = truth_of(scene);
    for (const Way& way : all_ways()) {
        const ImageF picture = render_linear(as(scene, way));
        EXPECT_EQ(impossible(scene, picture), "") << to_string(way);
        double rel = 0;
        int count = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 36; x < 64; ++x)
                for (int c = 0; c < 3; ++c)
                    if (const double b = double(truth.at(x, y)[c]); std::isfinite(b) && b > 0) rel += std::abs(double(picture.at(x, y)[c]) / b - 1), ++count;
        hold("range of radiance", way, "rel in the dim room", rel / count, "1e-6 beside 1e6");
        hold("range of radiance", way, "rel", off_by(scene, picture, truth).rel, "1e-6 beside 1e6");
    }
}

TEST(Range, AnyExponentGivesTheSamePictureTimesIt) {
    Scene scene = canvas(48, 40);
    scene.shapes = lamps_and_walls({24.3, 20.2}, 20);
    for (const Way& way : main_ways()) {
        const ImageF plain = render_linear(as(scene, way));
        // Powers of two: nothing is rounded, from 1e-9 to 1e8.
        for (const int exponent : {-30, -20, 20, 27}) {
            Scene other = scene;
            for (Shape& s : other.shapes) s.emission *= std::ldexp(1.0, exponent);
            ImageF picture = render_linear(as(other, way));
            for (float& v : picture.data) v = std::ldexp(v, -exponent);
            hold("exponents", way, "max", apart(picture, plain).max, text("radiance times 2^", exponent));
        }
    }
}

TEST(Range, NegativeZeroIsZero) {
    Scene scene = canvas(24, 24);
    scene.sky.radiance = Colour(-0.0);
    scene.shapes = {shape(Circle{{8, 8}, 3}, Colour(-0.0)), shape(Circle{{16, 16}, 3}, Colour(0, -0.0, 1))};
    for (const Way& way : all_ways()) EXPECT_EQ(impossible(scene, render_linear(as(scene, way))), "") << to_string(way);
}

TEST(Range, TenThousandEmittersAddUp) {
    // A grid of specks, seen from around and between.
    const int side = 100;
    Scene scene = canvas(144, 144);
    Numbers numbers(12);
    for (int i = 0; i < side * side; ++i)
        scene.shapes.push_back(shape(Circle{{12.13 + 1.2 * (i % side) + numbers.between(0, 0.5), 12.17 + 1.2 * (i / side) + numbers.between(0, 0.5)}, 0.15}, Colour(1 + i % 3, 1, 1 + i % 7)));
    const ImageF truth = truth_of(scene, 12);
    for (const Way& way : {Way{"hrc", Quality::standard}, Way{"rc_fix", Quality::draft}, Way{"rc", Quality::standard}, Way{"exact", Quality::draft}}) {
        if (scale() == 1 && way.method == "exact") continue;
        ImageF picture;
        try {
            picture = render_linear(as(scene, way));
        } catch (const DeviceError& refused) {
            hold("ten thousand emitters", way, "refused", 1, refused.what());
            continue;
        }
        EXPECT_EQ(impossible(scene, picture), "") << to_string(way);
        hold("ten thousand emitters", way, "bias", off_by(scene, picture, truth).bias, "10,000 discs of 0.15 px, 1.2 px apart");
    }
}

// ---- degenerate shapes ----

struct Odd {
    const char* name;
    std::function<void(Scene&)> fill;
};

const std::vector<Odd>& odd_scenes() {
    static const std::vector<Odd> kOdd = {
        {"radius of a thousandth of a pixel", [](Scene& s) { s.shapes = {shape(Circle{{20.3, 20.4}, 1e-3}, Colour(1000)), shape(Circle{{30.1, 12.2}, 1e-3})}; }},
        {"coincident", [](Scene& s) {
             for (const Colour light : {Colour(1, 0, 0), Colour(0), Colour(0, 1, 0)}) s.shapes.push_back(shape(Rect{{20.2, 20.3}, {9, 6}, 17, 0}, light));
             for (const Colour light : {Colour(0), Colour(0, 0, 2)}) s.shapes.push_back(shape(Circle{{33.2, 30.3}, 4}, light));
         }},
        {"touching", [](Scene& s) {
             s.shapes = {shape(Rect{{15.25, 20.25}, {6, 4}, 0, 0}, Colour(1)), shape(Rect{{20.25, 20.25}, {4, 4}, 0, 0}), shape(Circle{{15.25, 25.25}, 3}),
                         shape(Circle{{20.25, 25.25}, 2}, Colour(0, 1, 0)), shape(Polygon{{{22.25, 22.25}, {22.25, 32.25}, {17.25, 32.25}}})};
         }},
        {"nested", [](Scene& s) {
             for (const double r : {2.0, 9.0, 6.0, 3.0}) s.shapes.push_back(shape(Circle{{24.1, 20.3}, r}, Colour(r, 1, 0)));
         }},
        {"a polygon that crosses itself", [](Scene& s) {
             Polygon star;
             for (int i = 0; i < 5; ++i) star.points.push_back(Point(24.3, 20.1) + 12.0 * Point(std::cos(2.513274 * i + 0.1), std::sin(2.513274 * i + 0.1)));
             s.shapes = {shape(star, Colour(1, 2, 3)), shape(Polygon{{{5.2, 5.1}, {15.3, 12.2}, {15.1, 5.3}, {5.4, 12.4}}})};
         }},
        {"points repeated and in line", [](Scene& s) {
             s.shapes = {shape(Polygon{{{10.1, 10.1}, {10.1, 10.1}, {15.1, 10.1}, {20.1, 10.1}, {20.1, 20.1}, {20.1, 20.1}, {10.1, 20.1}, {10.1, 15.1}}}, Colour(1)),
                         shape(Polyline{{{28.3, 10.2}, {28.3, 10.2}, {33.3, 15.2}, {38.3, 20.2}, {33.3, 15.2}}, 1, false}, Colour(0, 1, 0))};
         }},
        {"a needle", [](Scene& s) { s.shapes = {shape(Rect{{24.3, 14.2}, {40, 4e-4}, 7, 0}, Colour(1)), shape(Polygon{{{4.1, 30.2}, {44.3, 27.1}, {44.3, 27.1004}}}), shape(Circle{{30.1, 35.2}, 2}, Colour(1))}; }},
        {"ellipses that are nearly lines", [](Scene& s) { s.shapes = {shape(Ellipse{{24.3, 14.2}, {20, 2e-4}, 7}, Colour(1)), shape(Ellipse{{20.3, 28.2}, {1e-3, 9}, 70}), shape(Circle{{30.1, 35.2}, 2}, Colour(1))}; }},
        {"ends of no length", [](Scene& s) { s.shapes = {shape(Line{{12.3, 12.2}, {12.3, 12.2}, 5}, Colour(1)), shape(Polyline{{{30.3, 20.2}, {30.3, 20.2}}, 4, true}, Colour(0, 1, 1))}; }},
        {"a shape that covers everything", [](Scene& s) { s.shapes = {shape(Circle{{24, 20}, 500}, Colour(1)), shape(Circle{{24, 20}, 5}, Colour(3))}; }},
        {"a shape that covers all but a corner", [](Scene& s) { s.shapes = {shape(Circle{{24, 120.3}, 116}, Colour(1)), shape(Circle{{4.3, 3.2}, 1.5}, Colour(3))}; }},
        {"walls on pixels' edges and centres", [](Scene& s) {
             s.shapes = {shape(Rect{{12, 20}, {1, 20}, 0, 0}), shape(Rect{{24.5, 20}, {1, 20}, 0, 0}), shape(Rect{{18, 20}, {2, 2}, 0, 0}, Colour(1)), shape(Rect{{34, 9.5}, {10, 2}, 0, 0}, Colour(0, 1, 0))};
         }},
        {"hairlines side by side", [](Scene& s) {
             for (int i = 0; i < 30; ++i) s.shapes.push_back(shape(Line{{8.1 + i, 6.3}, {10.7 + i, 26.2}, 0.02}, i % 5 == 0 ? Colour(2) : Colour(0)));
             s.shapes.push_back(shape(Circle{{24.3, 34.1}, 2}, Colour(1, 0, 0)));
         }},
    };
    return kOdd;
}

TEST(Degenerate, ShapesOfAllKinds) {
    for (const Odd& odd : odd_scenes())
        for (const bool sky : {false, true}) {
            Scene scene = canvas(48, 40);
            odd.fill(scene);
            if (sky) scene.sky.radiance = {0.1, 0.2, 0.3};
            judge("degenerate shapes", scene, std::string(odd.name) + (sky ? ", under a sky" : ""), all_ways());
        }
}

TEST(Degenerate, TenThousandShapesInOnePixel) {
    Numbers numbers(5);
    Scene scene = with(canvas(24, 24), {shape(Circle{{4.3, 5.2}, 2}, Colour(1))});
    const int count = scale() > 1 ? 10'000 : 2'000;
    for (int i = 0; i < count; ++i)
        scene.shapes.push_back(shape(Circle{{14 + numbers.next(), 14 + numbers.next()}, 0.002}, i % 2 == 0 ? Colour(1) : Colour(0)));
    const ImageF truth = truth_of(scene, 4);
    for (const Way& way : {Way{"exact", Quality::draft}, Way{"hrc", Quality::standard}, Way{"rc_fix", Quality::standard}, Way{"rc", Quality::standard}, Way{"auto", Quality::standard}}) {
        ImageF picture;
        try {
            picture = render_linear(as(scene, way));
        } catch (const DeviceError& refused) {
            // In words, and only by the method that solves; `auto` must find another.
            EXPECT_EQ(way.method, "exact") << refused.what();
            hold("ten thousand shapes in a pixel", way, "refused", 1, refused.what());
            continue;
        }
        EXPECT_EQ(impossible(scene, picture), "") << to_string(way);
        hold("ten thousand shapes in a pixel", way, "mean of peak", off_by(scene, picture, truth).of_peak, text(count, " discs of 0.002 px within one pixel"));
    }
}

// ---- canvases ----

TEST(Canvases, OfOnePixelPrimesAndStrips) {
    struct Size {
        int width, height;
    };
    for (const Size size : {Size{1, 1}, Size{2, 1}, Size{3, 5}, Size{1, 127}, Size{131, 1}, Size{61, 7}, Size{13, 97}}) {
        Scene scene = canvas(size.width, size.height);
        const double w = size.width, h = size.height;
        scene.sky.radiance = {0.02, 0.01, 0.03};
        scene.canvas.margin = 7.3;
        scene.shapes = {shape(Circle{{0.3 * w, h + 3.2}, 2.5}, Colour(1, 2, 3)), shape(Circle{{0.8 * w + 2, 0.4 * h - 3}, 1.2})};
        judge("canvases", scene, text(size.width, " x ", size.height), all_ways());
    }
}

TEST(Canvases, AStripOfTheLargestSide) {
    for (const bool tall : {true, false}) {
        Scene scene = canvas(tall ? 1 : 8192, tall ? 8192 : 1);
        const auto at = [&](double along, double across) { return tall ? Point(across, along) : Point(along, across); };
        scene.canvas.margin = 12;
        scene.shapes = {shape(Circle{at(100.3, 9.2), 4}, Colour(1, 2, 3)), shape(Circle{at(8000.3, -7.2), 3}, Colour(2, 1, 0)), shape(Circle{at(4000, 5.2), 2})};
        const ImageF truth = truth_of(scene, 1);
        for (const Way& way : {Way{"exact", Quality::standard}, Way{"hrc", Quality::draft}, Way{"rc_fix", Quality::draft}, Way{"rc", Quality::draft}}) {
            if (scale() == 1 && way.method != "exact" && !tall) continue;
            ImageF picture;
            try {
                picture = render_linear(as(scene, way));
            } catch (const DeviceError& refused) {
                hold("strips of 8192", way, "refused", 1, refused.what());
                continue;
            }
            EXPECT_EQ(impossible(scene, picture), "") << to_string(way);
            hold("strips of 8192", way, "mean of peak", off_by(scene, picture, truth).of_peak, tall ? "1 x 8192" : "8192 x 1");
            hold("strips of 8192", way, "rel", off_by(scene, picture, truth).rel, tall ? "1 x 8192" : "8192 x 1");
        }
    }
}

// The largest picture of all: minutes and gigabytes, so at night.
TEST(Canvases, TheLargest) {
    if (scale() == 1) GTEST_SKIP() << "nightly only";
    Scene scene = with(canvas(8192, 8192), {shape(Circle{{2000.3, 3000.2}, 400}, Colour(1)), shape(Rect{{5000, 4000}, {200, 3000}, 10, 0})});
    const ImageF truth = truth_of(scene, 512);
    for (const Way& way : {Way{"exact", Quality::draft}}) {
        const ImageF picture = render_linear(as(scene, way));
        EXPECT_EQ(impossible(scene, picture), "") << to_string(way);
        hold("8192 x 8192", way, "rel", off_by(scene, picture, truth).rel, "a disc and a wall");
    }
}

// ---- far from the origin ----

TEST(Origin, OneThatIsFarOffIsTakenAwayBeforeDigitsAreLost) {
    Scene near = canvas(48, 40);
    near.shapes = lamps_and_walls({24.25, 20.5}, 20);
    for (const Way& way : main_ways()) {
        const ImageF plain = render_linear(as(near, way));
        for (const double offset : {1e3, 1e6, 1e8}) {
            Motion m;
            m.by = {offset, -offset};
            Scene far = near;
            far.shapes = moved(near.shapes, m);
            far.canvas.view = ViewRect{offset, -offset, 48, 40};
            hold("far origin", way, "max", apart(render_linear(as(far, way)), plain).max, text("view and scene moved by ", offset, " px"));
        }
    }
}

}  // namespace
}  // namespace penumbra::test
