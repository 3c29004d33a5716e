// SPDX-License-Identifier: MIT
// Paths and texts as rings: areas known in closed form, every command of the grammar, winding against a count by hand.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/outline/path_data.h"
#include "core/outline/text.h"
#include "test_scenes.h"

namespace penumbra {
namespace {

using testing::ElementsAre;

std::vector<Ring> rings(const std::string& d, double tolerance = 0.001) {
    auto result = rings_of_path(d, tolerance, 100000);
    if (const auto* error = std::get_if<PathError>(&result)) {
        ADD_FAILURE() << d << ": at " << error->at << " " << error->message;
        return {};
    }
    return std::get<std::vector<Ring>>(result);
}

double area(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point a = ring[i], b = ring[(i + 1) % ring.size()];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum / 2;
}

// Of the plane filled by the even-odd rule, where rings do not cross: nested rings alternate, and even_odd_of_nonzero() turns holes
// the other way.
double signed_area(const std::vector<Ring>& all) {
    double sum = 0;
    for (const Ring& ring : all) sum += area(ring);
    return sum;
}

bool inside(const std::vector<Ring>& all, Point p, bool nonzero) {
    int winding = 0, crossings = 0;
    for (const Ring& ring : all)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point a = ring[i], b = ring[(i + 1) % ring.size()];
            if ((a.y > p.y) == (b.y > p.y) || p.x >= a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) continue;
            winding += b.y > a.y ? 1 : -1;
            ++crossings;
        }
    return nonzero ? winding != 0 : crossings % 2 == 1;
}

TEST(PathData, EveryCommandOfLines) {
    const Ring square{{10, 10}, {30, 10}, {30, 25}, {10, 25}};
    for (const char* d : {"M10 10 L30 10 L30 25 L10 25 Z", "M10,10L30,10 30,25 10,25z", "m10 10 20 0 0 15-20 0", "M10 10H30V25H10Z",
                          "m10 10h20v15h-20z", "  M 1e1,+10\n h20. v.15e2 h-20 z ", "M10 10 L30 10 L30 25 L10 25 L10 10"}) {
        const auto all = rings(d);
        ASSERT_EQ(all.size(), 1u) << d;
        EXPECT_EQ(all[0], square) << d;
    }
}

TEST(PathData, NumbersRunTogetherAsTheGrammarAllows) {
    EXPECT_EQ(rings("M.5.5-1-2+3.25.5e1")[0], (Ring{{0.5, 0.5}, {-1, -2}, {3.25, 5}}));
    // Flags need no separators.
    EXPECT_EQ(rings("M0 0A5 5 0 0110 0Z"), rings("M0 0 A 5 5 0 0 1 10 0 Z"));
}

TEST(PathData, SubpathsStartWhereTheLastOneStarted) {
    const auto all = rings("M10 10h5v5z m20 0h5v5z L2 2 L3 9");
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[1][0], Point(30, 10));
    EXPECT_EQ(all[2][0], Point(30, 10)) << "after Z the pen stands at the start of the subpath";
    EXPECT_EQ(rings("M1 1").size(), 0u);
    EXPECT_EQ(rings("M1 1 2 2 M5 5 6 6 7 9").size(), 2u);
}

TEST(PathData, ArcsAreCirclesAndEllipses) {
    // Two half circles; the polygon's area is less by what the chords cut off.
    for (const double tolerance : {0.1, 0.01, 0.001}) {
        const auto circle = rings("M-20 0a20 20 0 1 0 40 0a20 20 0 1 0-40 0z", tolerance);
        ASSERT_EQ(circle.size(), 1u);
        double worst = 0;
        for (std::size_t i = 0; i < circle[0].size(); ++i) {
            const Point a = circle[0][i], b = circle[0][(i + 1) % circle[0].size()];
            EXPECT_NEAR(std::hypot(a.x, a.y), 20, 1e-9);
            worst = std::max(worst, 20 - std::hypot((a.x + b.x) / 2, (a.y + b.y) / 2));
        }
        EXPECT_LE(worst, tolerance * 1.0001);
        EXPECT_GE(worst, tolerance / 2) << "no finer than asked for";
        EXPECT_NEAR(std::abs(area(circle[0])), 400 * std::numbers::pi, 2 * 2 * std::numbers::pi * 20 * tolerance);
    }
    // A whole ellipse of two arcs, turned: area pi a b.
    const auto ellipse = rings("M0 0 A 30 10 27 1 1 10 8 A 30 10 27 1 1 0 0", 1e-5);
    const auto small = rings("M0 0 A 30 10 27 0 1 10 8 A 30 10 27 0 1 0 0", 1e-5);
    EXPECT_GT(std::abs(signed_area(ellipse)), 2 * std::abs(signed_area(small)));
    const auto half = rings("M-30 0 A 30 10 0 0 1 30 0 z", 1e-5);
    EXPECT_NEAR(std::abs(signed_area(half)), std::numbers::pi * 300 / 2, 0.01);
    // Sweep 1 turns towards growing angles: with y down, over the top from left to right.
    EXPECT_NEAR(rings("M-10 0 A 10 10 0 0 1 10 0 z", 1e-4)[0][1].y, -std::abs(rings("M-10 0 A 10 10 0 0 1 10 0 z", 1e-4)[0][1].y), 0);
    EXPECT_GT(rings("M-10 0 A 10 10 0 0 0 10 0 z", 1e-4)[0][1].y, 0);
}

TEST(PathData, SmallRadiiAreMadeLargeEnoughAndZeroIsALine) {
    EXPECT_NEAR(std::abs(signed_area(rings("M-30 0 A 1 1 0 0 1 30 0 z", 1e-4))), std::numbers::pi * 900 / 2, 0.1);
    EXPECT_EQ(rings("M0 0 A 0 5 0 0 1 30 0 L 3 9")[0].size(), 3u);
    EXPECT_EQ(rings("M0 0 A 5 5 0 0 1 0 0 L 3 9 L 9 3")[0].size(), 3u);
}

TEST(PathData, BeziersHaveTheirArea) {
    // Under a quadratic over a chord, two thirds of its triangle; under the cubic that is the same curve, too.
    EXPECT_NEAR(std::abs(signed_area(rings("M0 0 Q 30 60 60 0 Z", 1e-4))), 2.0 / 3 * 0.5 * 60 * 60, 0.02);
    EXPECT_NEAR(std::abs(signed_area(rings("M0 0 C 20 40 40 40 60 0 Z", 1e-4))), 2.0 / 3 * 0.5 * 60 * 60, 0.02);
    // Relative, and smooth ones that mirror the control point.
    EXPECT_EQ(rings("M5 5 q 30 60 60 0 t 60 0"), rings("M5 5 Q 35 65 65 5 Q 95 -55 125 5"));
    EXPECT_EQ(rings("M5 5 c 10 40 40 40 60 0 s 20 -20 60 0"), rings("M5 5 C 15 45 45 45 65 5 C 85 -35 85 -15 125 5"));
    EXPECT_EQ(rings("M0 0 L 9 0 S 20 20 30 0"), rings("M0 0 L 9 0 C 9 0 20 20 30 0"));
    EXPECT_EQ(rings("M0 0 L 9 0 T 30 10 L 0 9"), rings("M0 0 L 9 0 Q 9 0 30 10 L 0 9"));
}

TEST(PathData, CurvesKeepTheirTolerance) {
    for (const double tolerance : {0.5, 0.02}) {
        const Ring ring = rings("M0 0 C 0 90 100 -60 80 50", tolerance)[0];
        double worst = 0;
        for (int i = 0; i <= 2000; ++i) {
            const double t = i / 2000.0, u = 1 - t;
            const Point p = Point(0, 90) * (3 * u * u * t) + Point(100, -60) * (3 * u * t * t) + Point(80, 50) * (t * t * t);
            double nearest = 1e9;
            for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
                const Point d = ring[k + 1] - ring[k];
                const Point q = p - ring[k];
                const double h = std::clamp((q.x * d.x + q.y * d.y) / (d.x * d.x + d.y * d.y), 0.0, 1.0);
                nearest = std::min(nearest, std::hypot(q.x - h * d.x, q.y - h * d.y));
            }
            worst = std::max(worst, nearest);
        }
        EXPECT_LE(worst, tolerance);
    }
}

TEST(PathData, MistakesAreToldWhereTheyStand) {
    const auto at = [](const std::string& d) {
        const auto result = rings_of_path(d, 0.1, 1000);
        const auto* error = std::get_if<PathError>(&result);
        return error != nullptr ? int(error->at) : -1;
    };
    EXPECT_EQ(at(""), -1);
    EXPECT_EQ(at("L 1 1"), 0);
    EXPECT_EQ(at("M 1 1 X 2"), 6);
    EXPECT_EQ(at("M 1 1 L 2"), 9);
    EXPECT_EQ(at("M 1 1 L 2 a"), 10);
    EXPECT_EQ(at("M 1 1 A 5 5 0 2 0 9 9"), 14);
    EXPECT_EQ(at("M 1 1 L 1e999 0"), 8);
    EXPECT_EQ(at("M 1 1 , L 2 2"), 6);
    EXPECT_EQ(at("M 1 1 L . 2"), 8);
}

TEST(PathData, NoTextDoesHarm) {
    const std::string letters = "MmLlHhVvCcSsQqTtAaZz0123456789.-+eE, \n#\xff";
    std::uint32_t state = 5;
    for (int run = 0; run < 20000; ++run) {
        std::string d = "M0 0";
        for (int i = 0; i < 24; ++i) d += letters[((state = state * 1664525u + 1013904223u) >> 8) % letters.size()];
        const auto result = rings_of_path(d, 0.01, 1000);
        if (const auto* all = std::get_if<std::vector<Ring>>(&result)) {
            for (const Ring& ring : *all) EXPECT_GE(ring.size(), 2u);
        }
    }
}

TEST(PathData, EndsSoonAfterTheMostPoints) {
    std::string d = "M0 0";
    for (int i = 0; i < 1000; ++i) d += " C 0 900 1000 -600 800 500";
    const auto result = rings_of_path(d, 1e-6, 5000);
    std::size_t points = 0;
    for (const Ring& ring : std::get<std::vector<Ring>>(result)) points += ring.size();
    EXPECT_GT(points, 5000u);
    EXPECT_LT(points, 5000u + 4097);
}

constexpr std::size_t kMuchWork = 1u << 20;

std::optional<std::vector<Ring>> solved(const std::vector<Ring>& nonzero, std::size_t most_splits) {
    CrossingWork work{kMuchWork};
    return even_odd_of_nonzero(nonzero, most_splits, work);
}

void expect_same_filling(const std::vector<Ring>& nonzero, const std::string& what) {
    const auto even_odd = solved(nonzero, 100000);
    ASSERT_TRUE(even_odd) << what;
    std::uint32_t state = 9;
    const auto next = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24); };
    for (int i = 0; i < 3000; ++i) {
        const Point p(-5 + 110 * next(), -5 + 110 * next());
        ASSERT_EQ(inside(*even_odd, p, false), inside(nonzero, p, true)) << what << " at " << p.x << " " << p.y;
    }
}

TEST(Winding, FillsWhatTheNonzeroRuleFills) {
    const Ring square{{10, 10}, {60, 10}, {60, 60}, {10, 60}};
    const Ring other{{40, 40}, {90, 40}, {90, 90}, {40, 90}};
    const Ring within{{20, 20}, {50, 20}, {50, 50}, {20, 50}};
    const Ring hole(within.rbegin(), within.rend());
    expect_same_filling({square}, "one");
    expect_same_filling({square, other}, "two that overlap");
    expect_same_filling({square, within}, "one in the other, the same way round");
    expect_same_filling({square, hole}, "a hole");
    expect_same_filling({square, square}, "one twice");
    expect_same_filling({square, Ring(square.rbegin(), square.rend())}, "one taken away again");
    expect_same_filling({square, {{60, 10}, {80, 10}, {80, 60}, {60, 60}}}, "a shared side");
    expect_same_filling({square, {{60, 20}, {80, 20}, {80, 50}, {60, 50}}}, "part of a side");
    expect_same_filling({square, {{30, 60}, {40, 80}, {20, 80}}}, "a corner on a side");
    Ring star;
    for (int i = 0; i < 5; ++i) star.push_back(Point(50) + 40.0 * Point(std::cos(4 * std::numbers::pi * i / 5), std::sin(4 * std::numbers::pi * i / 5)));
    expect_same_filling({star}, "a star that crosses itself");
    std::uint32_t state = 3;
    const auto next = [&] { return 100.0 * double((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24); };
    for (int run = 0; run < 12; ++run) {
        std::vector<Ring> tangle(3);
        for (Ring& ring : tangle)
            for (int i = 0; i < 12; ++i) ring.push_back({next(), next()});
        expect_same_filling(tangle, "tangle " + std::to_string(run));
    }
    // On a coarse grid, where edges lie on each other and meet in corners.
    for (int run = 0; run < 30; ++run) {
        std::vector<Ring> tangle(3);
        for (Ring& ring : tangle)
            for (int i = 0; i < 7; ++i) ring.push_back({std::floor(next() / 20) * 20, std::floor(next() / 20) * 20});
        expect_same_filling(tangle, "grid " + std::to_string(run));
    }
}

TEST(Winding, AreasAreExact) {
    const Ring square{{10, 10}, {60, 10}, {60, 60}, {10, 60}};
    const Ring other{{40, 40}, {90, 40}, {90, 90}, {40, 90}};
    EXPECT_NEAR(std::abs(signed_area(*solved({square, other}, 100))), 2 * 2500 - 400, 1e-3);
    // Nothing left inside: one ring of eight corners.
    const auto joined = *solved({square, other}, 100);
    ASSERT_EQ(joined.size(), 1u);
    EXPECT_EQ(joined[0].size(), 8u);
    EXPECT_TRUE(solved({}, 100)->empty());
    EXPECT_TRUE(solved({{{1, 1}, {1, 1}}}, 100)->empty());
}

TEST(Winding, BeyondAnyGridNothingIsDone) {
    for (const double side : {1e308, 1e-310}) {
        const std::vector<Ring> ring{{{-side, -side}, {side, 0}, {0, side}}};
        EXPECT_EQ(*solved(ring, 100), ring) << side;
    }
}

// Of 16,384 points, as many as a path may have: what crossings cost until it is solved or refused.
struct Cost {
    bool solved = false;
    std::size_t work = 0;
};
Cost cost(const std::vector<Ring>& nonzero) {
    CrossingWork work{kMuchWork};
    const bool is_solved = even_odd_of_nonzero(nonzero, 65536, work).has_value();
    return {is_solved, kMuchWork - work.left};
}

Ring zigzag(int count, Point even, Point odd, Point step) {
    Ring ring;
    for (int i = 0; i < count; ++i) ring.push_back((i % 2 == 0 ? even : odd) + double(i) * step);
    return ring;
}

TEST(Winding, GivesUpInsteadOfTakingForEver) {
    // What may be split 65,536 times may cross half as often; a crossing costs two, one for its place and one for its pair.
    const auto refused = [](const std::vector<Ring>& nonzero, const std::string& what) {
        const Cost c = cost(nonzero);
        EXPECT_FALSE(c.solved) << what;
        EXPECT_LE(c.work, 100000u) << what;
    };
    refused({zigzag(800, {0, 0}, {0, 400}, {1, 0}), zigzag(800, {0, 0}, {400, 0}, {0, 1})}, "a weave");
    Ring star, tangle;
    std::uint32_t state = 3;
    const auto next = [&] { return double((state = state * 1664525u + 1013904223u) >> 8); };
    for (int i = 0; i < 16384; ++i) {
        const double angle = 2 * std::numbers::pi * i * 8191 / 16384;
        star.push_back(1000.0 * Point(std::cos(angle), std::sin(angle)));
        tangle.push_back({next(), next()});
    }
    refused({star}, "a star");
    refused({tangle}, "a tangle");
    // All through one point: too many pairs there.
    std::vector<Ring> lines;
    for (int i = 0; i < 4096; ++i) lines.push_back({{i * 16.0, 0}, {65536.0 - i * 16.0, 65536}, {65536.0 - i * 16.0, 65536 - 1 - i % 7}});
    refused(lines, "lines through a point");
}

TEST(Winding, ManyEdgesThatDoNotCrossAreLittleWork) {
    const auto costs = [](const std::vector<Ring>& nonzero, std::size_t most, const std::string& what) {
        const Cost c = cost(nonzero);
        EXPECT_TRUE(c.solved) << what;
        EXPECT_LE(c.work, most) << what;
    };
    // The edge that closes a zigzag crosses all others.
    costs({zigzag(16000, {0, 0}, {1000, 1000}, {1e-4, 0})}, 2 * 16000, "a bundle");
    costs({zigzag(16000, {0, 0}, {1000, 0}, {0, 0.01})}, 2 * 16000, "a hatching across");
    costs({zigzag(16000, {0, 0}, {0, 1000}, {0.01, 0})}, 2 * 16000, "a hatching upwards");
    costs({Ring(16384, Point(0)), zigzag(16384, {0, 0}, {1000, 7}, {0, 0})}, 0, "one edge again and again");
    std::vector<Ring> bars, rays;
    for (int i = 0; i < 4096; ++i) {
        const double angle = 2 * std::numbers::pi * i / 4096, other = 2 * std::numbers::pi * (i + 0.5) / 4096;
        bars.push_back({{0, i * 1.0}, {4096, i * 1.0}, {4096, i + 0.4}, {0, i + 0.4}});
        rays.push_back({{0, 0}, 1000.0 * Point(std::cos(angle), std::sin(angle)), 1000.0 * Point(std::cos(other), std::sin(other))});
    }
    costs(bars, 0, "bars");
    costs(rays, 0, "rays from one point");
}

TEST(Winding, WorkIsSharedByAllThatIsSolved) {
    const std::vector<Ring> weave{zigzag(100, {0, 0}, {0, 100}, {1, 0}), zigzag(100, {0, 0}, {100, 0}, {0, 1})};
    const std::size_t once = cost(weave).work;
    ASSERT_GT(once, 1000u);
    CrossingWork work{2 * once};
    EXPECT_TRUE(even_odd_of_nonzero(weave, 65536, work));
    EXPECT_TRUE(even_odd_of_nonzero(weave, 65536, work));
    EXPECT_EQ(work.left, 0u);
    EXPECT_FALSE(even_odd_of_nonzero(weave, 65536, work));
    EXPECT_TRUE(even_odd_of_nonzero({{{0, 0}, {9, 0}, {9, 9}}}, 65536, work));  // nothing crosses
}

// ---- text: Debian's DejaVu Sans, whose letters have simple measures

const Font& font() {
    static const FontSource kSource;
    EXPECT_NE(kSource.font(), nullptr) << kSource.why();
    return *kSource.font();
}

std::vector<Ring> text(const std::string& utf8, TextSettings settings = {}) {
    if (settings.size == 1) settings.size = 2048;  // the font's own units
    settings.tolerance = 1;
    auto result = rings_of_text(font(), utf8, settings);
    if (const auto* error = std::get_if<FontError>(&result)) {
        ADD_FAILURE() << error->message;
        return {};
    }
    return std::get<std::vector<Ring>>(result);
}

struct Extent {
    Point low{1e300}, high{-1e300};
};
Extent extent(const std::vector<Ring>& all) {
    Extent e;
    for (const Ring& ring : all)
        for (const Point& p : ring) {
            e.low = {std::min(e.low.x, p.x), std::min(e.low.y, p.y)};
            e.high = {std::max(e.high.x, p.x), std::max(e.high.y, p.y)};
        }
    return e;
}

TEST(Text, LettersAreTheFontsOwn) {
    EXPECT_EQ(text("l").size(), 1u);
    EXPECT_EQ(text("o").size(), 2u);
    EXPECT_EQ(text("i").size(), 2u);
    EXPECT_EQ(text("B").size(), 3u);
    EXPECT_EQ(text(" ").size(), 0u);
    // A capital I of DejaVu Sans is a box of 201 to 403 by 1493 units.
    const Extent i = extent(text("I"));
    EXPECT_EQ(i.low.x, 201);
    EXPECT_EQ(i.high.x, 403);
    EXPECT_EQ(i.high.y, 0);
    EXPECT_EQ(i.low.y, -1493);
}

TEST(Text, SizeIsTheEm) {
    TextSettings settings;
    settings.size = 204.8;
    const Extent i = extent(text("I", settings));
    EXPECT_NEAR(i.high.x - i.low.x, 20.2, 1e-9);
    EXPECT_NEAR(i.low.y, -149.3, 1e-9);
}

TEST(Text, AnchorsMoveByTheWidth) {
    // An I is 604 units wide.
    TextSettings settings;
    EXPECT_EQ(extent(text("II")).low.x, 201);
    settings.anchor = TextAnchor::middle;
    EXPECT_EQ(extent(text("II", settings)).low.x, 201 - 604);
    settings.anchor = TextAnchor::end;
    EXPECT_EQ(extent(text("II", settings)).low.x, 201 - 1208);
    EXPECT_EQ(extent(text("II", settings)).high.x, 403 - 604);
}

TEST(Text, KerningBringsPairsTogether) {
    const double apart = extent(text("A")).high.x - extent(text("A")).low.x;
    const Extent pair = extent(text("AV"));
    const Extent v = extent(text("V"));
    EXPECT_GT(apart, 0);
    // Without kerning V would start at A's advance, 1401.
    EXPECT_LT(pair.high.x, 1401 + v.high.x - 50);
}

TEST(Text, LinesGoDown) {
    const Extent two = extent(text("I\nI"));
    EXPECT_EQ(two.low.y, -1493);
    EXPECT_NEAR(two.high.y, 2384, 1) << "the font's line height";
}

TEST(Text, Utf8OfEveryLength) {
    EXPECT_GE(text("\xc3\xa9").size(), 3u);          // é: two rings and its accent
    EXPECT_GE(text("\xe2\x82\xac").size(), 1u);      // the euro sign
    EXPECT_GE(text("\xf0\x9d\x94\xb8").size(), 2u);  // U+1D538, a double-struck A
    EXPECT_EQ(extent(text("\xce\xa9")).high.x, extent(text("\xe2\x84\xa6")).high.x) << "Omega and Ohm look the same";
}

TEST(Text, MissingGlyphsAreNamed) {
    const auto result = rings_of_text(font(), "ab\xe4\xb8\xad", {});
    const auto* error = std::get_if<FontError>(&result);
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->code, "missing_glyph");
    EXPECT_EQ(error->message, "holds \"\xe4\xb8\xad\" (U+4E2D), for which the font DejaVu Sans has no glyph");
}

TEST(Text, FontsThatAreNone) {
    EXPECT_TRUE(std::holds_alternative<std::string>(load_font({})));
    EXPECT_TRUE(std::holds_alternative<std::string>(load_font(std::vector<std::uint8_t>(5000, 7))));
    const FontSource nowhere("/nowhere/font.ttf");
    EXPECT_EQ(nowhere.font(), nullptr);
    EXPECT_NE(nowhere.why().find("/nowhere/font.ttf"), std::string::npos);
}

// ---- the scene

Polygon only_polygon(const std::string& shape) {
    const ParsedScene parsed = parse_scene(with_shape(shape));
    if (!parsed.scene) {
        ADD_FAILURE() << all_text(parsed);
        return {};
    }
    return std::get<Polygon>(parsed.scene->shapes.at(0).geometry);
}

std::vector<std::string> problems(const std::string& shape) { return brief(parse_scene(with_shape(shape))); }

TEST(OutlineShapes, PathsArePolygonsInTheirPlace) {
    const Polygon square = only_polygon(R"({"type": "path", "d": "M0 0h4v4h-4z M1 1v2h2v-2z", "position": [10, 20], "scale": 2})");
    EXPECT_EQ(square.points.size(), 8u);
    EXPECT_THAT(square.ring_starts, ElementsAre(4u));
    double low = 1e9, high = -1e9;
    for (const Point& p : square.points) {
        low = std::min(low, p.x);
        high = std::max(high, p.y);
    }
    EXPECT_NEAR(low, 10, 1e-6);
    EXPECT_NEAR(high, 28, 1e-6);
}

TEST(OutlineShapes, TheFillRuleCounts) {
    // The same way round: nonzero fills the inner square, even-odd leaves it open.
    const std::string d = R"("d": "M0 0h9v9h-9z M3 3h3v3h-3z")";
    EXPECT_EQ(only_polygon(R"({"type": "path", )" + d + "}").ring_starts.size(), 0u);
    EXPECT_EQ(only_polygon(R"({"type": "path", )" + d + R"(, "fill_rule": "evenodd"})").ring_starts.size(), 1u);
}

TEST(OutlineShapes, CurvesAreAsFineAsPixelsAsk) {
    const auto count = [](double view) {
        const std::string text = R"({"version": 1, "canvas": {"width": 100, "height": 100, "view": [0, 0, )" + std::to_string(view) + ", " +
                                 std::to_string(view) + R"(]}, "shapes": [{"type": "path", "d": "M0 5a5 5 0 0 0 10 0a5 5 0 0 0-10 0"}]})";
        return std::get<Polygon>(parse_scene(text).scene->shapes[0].geometry).points.size();
    };
    // Edges go with the root of radius over tolerance: a view ten times as near takes the root of ten as many.
    EXPECT_NEAR(double(count(10)) / double(count(100)), std::sqrt(10.0), 0.4);
    // pi / acos(1 - 0.05 / 5) for a radius of five pixels.
    EXPECT_NEAR(double(count(100)), std::numbers::pi / std::acos(1 - 0.05 / 5), 2.5);
}

TEST(OutlineShapes, TextsArePolygons) {
    const Polygon o = only_polygon(R"({"type": "text", "text": "o", "position": [5, 20], "size": 16, "emission": 2})");
    EXPECT_EQ(o.ring_starts.size(), 1u);
    for (const Point& p : o.points) {
        EXPECT_GT(p.x, 5);
        EXPECT_LT(p.y, 20.5);
    }
}

TEST(OutlineShapes, WhatIsWrongIsTold) {
    EXPECT_THAT(problems(R"({"type": "path"})"), ElementsAre("/shapes/0/d missing_key"));
    EXPECT_THAT(problems(R"({"type": "path", "d": 3})"), ElementsAre("/shapes/0/d wrong_type"));
    EXPECT_THAT(problems(R"({"type": "path", "d": "h5"})"), ElementsAre("/shapes/0/d bad_path"));
    EXPECT_THAT(problems(R"({"type": "path", "d": ""})"), ElementsAre("/shapes/0/d zero_area"));
    EXPECT_THAT(problems(R"({"type": "path", "d": "M0 0 L5 5"})"), ElementsAre("/shapes/0/d zero_area"));
    EXPECT_THAT(problems(R"({"type": "path", "d": "M0 0h5v5z", "scale": 0})"), ElementsAre("/shapes/0/scale out_of_range"));
    EXPECT_THAT(problems(R"({"type": "path", "d": "M0 0h5v5z", "position": [1]})"), ElementsAre("/shapes/0/position wrong_length"));
    EXPECT_THAT(problems(R"({"type": "path", "d": "M0 0h5v5z", "fill_rule": "odd"})"), ElementsAre("/shapes/0/fill_rule unknown_value"));
    EXPECT_THAT(problems(R"({"type": "path", "d": "M0 0h2e9v2e9z"})"), ElementsAre("/shapes/0/d out_of_range"));
    EXPECT_THAT(problems(R"({"type": "text", "position": [1, 1], "size": 9})"), ElementsAre("/shapes/0/text missing_key"));
    EXPECT_THAT(problems(R"({"type": "text", "text": "a", "size": 9})"), ElementsAre("/shapes/0/position missing_key"));
    EXPECT_THAT(problems(R"({"type": "text", "text": "a", "position": [1, 1]})"), ElementsAre("/shapes/0/size missing_key"));
    EXPECT_THAT(problems(R"({"type": "text", "text": "a", "position": [1, 1], "size": -2})"), ElementsAre("/shapes/0/size out_of_range"));
    EXPECT_THAT(problems(R"({"type": "text", "text": "   ", "position": [1, 1], "size": 9})"), ElementsAre("/shapes/0/text zero_area"));
    EXPECT_THAT(problems(R"({"type": "text", "text": "\u4e2d", "position": [1, 1], "size": 9})"), ElementsAre("/shapes/0/text missing_glyph"));
    EXPECT_THAT(problems(R"({"type": "text", "text": "a", "position": [1, 1], "size": 9, "anchor": "left"})"),
                ElementsAre("/shapes/0/anchor unknown_value"));
    std::string d = "M0 0";
    for (int i = 0; i < 16400; ++i) d += "l1 " + std::to_string(i % 2);
    EXPECT_THAT(problems(R"({"type": "path", "d": ")" + d + R"("})"), ElementsAre("/shapes/0/d too_many"));
    std::string hatch = "M0 0";
    for (int i = 0; i < 16000; ++i) hatch += i % 2 == 0 ? "L256 " + std::to_string(i * 0.016) : "L0 " + std::to_string(i * 0.016);
    EXPECT_THAT(problems(R"({"type": "path", "d": ")" + hatch + R"("})"), ElementsAre("/shapes/0/d too_many"));
    const ParsedScene no_font = parse_scene(with_shape(R"({"type": "text", "text": "a", "position": [1, 1], "size": 9})"), {}, {}, {}, FontSource("/nowhere"));
    EXPECT_THAT(brief(no_font), ElementsAre("/shapes/0/text no_font"));
}

}  // namespace
}  // namespace penumbra
