// SPDX-License-Identifier: MIT
// What holds of light whatever the method: furnaces, sums, moves, energy, shadows, walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

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

Scene room(int width = 64, int height = 48) {
    Scene scene = canvas(width, height);
    scene.shapes = lamps_and_walls({0.5 * width + 0.27, 0.5 * height - 0.19}, 0.5 * std::min(width, height));
    return scene;
}

TEST(Laws, AClosedFurnaceHasItsOneRadianceEverywhere) {
    std::vector<std::pair<std::string, Scene>> scenes;
    Scene open = room(61, 47);
    open.sky.radiance = Colour(1);
    scenes.emplace_back("shapes under a sky of the same light", open);
    Scene box = with(room(53, 53), {shape(Polyline{{{3.4, 3.3}, {49.7, 3.9}, {49.2, 49.1}, {4.1, 48.6}}, 1.3, true})});
    scenes.emplace_back("a closed room whose walls shine", box);
    for (int i = 0; i < 4 * scale(); ++i) {
        Scene random = mild_scene(500 + std::uint64_t(i));
        random.sky = {};
        random.sky.radiance = Colour(1);
        std::erase_if(random.shapes, [](const Shape& s) { return std::holds_alternative<Bitmap>(s.geometry); });
        scenes.emplace_back(text("mild scene ", 500 + i), random);
    }
    for (auto& [name, scene] : scenes) {
        for (Shape& s : scene.shapes) s.emission = Colour(1);
        const ImageF truth = truth_of(scene);
        for (const Way& way : all_ways()) {
            const ImageF picture = render_linear(as(scene, way));
            double most = 0;
            for (std::size_t i = 0; i < truth.data.size(); ++i) {
                const int x = static_cast<int>(i / 3) % scene.canvas.width, y = static_cast<int>(i / 3) / scene.canvas.width;
                const bool outside = &scene != &scenes[1].second ? false : x < 5 || y < 5 || x > 47 || y > 46;  // of the room
                if (std::isfinite(truth.data[i]) && !outside) most = std::max(most, std::abs(double(picture.data[i]) - 1));
            }
            hold("furnace", way, "max", most, name);
        }
    }
}

TEST(Laws, LightsApartSumToBothTogether) {
    for (int i = 0; i < 3 * scale(); ++i) {
        Scene both = i == 0 ? room() : mild_scene(600 + std::uint64_t(i));
        both.sky.gradient.clear();
        Scene first = both, second = both;
        second.sky.radiance = Colour(0);
        bool take = true;
        for (std::size_t k = 0; k < both.shapes.size(); ++k) {
            const auto off = [](Shape& s) {
                s.emission = Colour(0);
                if (auto* bitmap = std::get_if<Bitmap>(&s.geometry)) bitmap->emission_scale = 0;
            };
            if (both.shapes[k].emission != Colour(0)) take = !take;
            off(take ? first.shapes[k] : second.shapes[k]);
        }
        const ImageF free = truth_of(both);
        for (const Way& way : main_ways()) {
            ImageF sum = render_linear(as(first, way));
            const ImageF other = render_linear(as(second, way));
            for (std::size_t k = 0; k < sum.data.size(); ++k) sum.data[k] = std::isfinite(free.data[k]) ? sum.data[k] + other.data[k] : NAN;
            const Apart d = apart(sum, render_linear(as(both, way)));
            hold("linearity", way, "rel", d.rel, i == 0 ? "room" : text("mild scene ", 600 + i));
            hold("linearity", way, "max", d.max, i == 0 ? "room" : text("mild scene ", 600 + i));
        }
    }
}

TEST(Laws, UnitsAndOriginsChangeNothing) {
    for (const auto& [name, scene] : {std::pair("room", room()), std::pair("mild scene 700", mild_scene(700))}) {
        std::vector<ImageF> plain;
        for (const Way& way : main_ways()) plain.push_back(render_linear(as(scene, way)));
        for (const double factor : {10.0, 0.125, 1e-3 / 64, 1e6 / 64})
            for (const double offset : {0.0, 1e6}) {
                // Far off and small, a double has no digits left: 1e6 and a pixel of 1.6e-5 leave 1e-5 px.
                Motion m;
                m.scale = factor;
                m.by = {offset, -offset};
                Scene other = scene;
                other.shapes = moved(scene.shapes, m);
                other.canvas.view = ViewRect{offset, -offset, scene.canvas.width * factor, scene.canvas.height * factor};
                other.canvas.margin = scene.canvas.margin * factor;
                for (std::size_t k = 0; k < main_ways().size(); ++k) {
                    const Apart d = apart(render_linear(as(other, main_ways()[k])), plain[k]);
                    const std::string what = text(name, ", view ", scene.canvas.width * factor, " wide", offset > 0 ? ", 1e6 off" : "");
                    hold("units", main_ways()[k], "rel", d.rel, what);
                    hold("units", main_ways()[k], "max", d.max, what);
                }
            }
    }
}

TEST(Laws, TurningTheSceneLeavesTheErrorAlone) {
    const int steps = scale() > 1 ? 360 : 30;
    const std::vector<Shape> still = {shape(Rect{{31.7, 20.3}, {14, 3}, 0, 0}, {3, 2, 1}), shape(Rect{{31.2, 33.1}, {9, 1.5}, 0, 0}),
                                      shape(Circle{{44.9, 37.7}, 3.1}), shape(Rect{{14.6, 33.2}, {1, 13}, 20, 0})};
    struct Seen {
        double least = 1e30, most = 0;
    };
    std::vector<Seen> seen(main_ways().size());
    for (int i = 0; i < steps; ++i) {
        Motion m;
        m.turned_deg = 360.0 * i / steps;
        m.centre = {32, 32};
        Scene scene = canvas(64, 64);
        scene.shapes = moved(still, m);
        const ImageF truth = truth_of(scene);
        for (std::size_t k = 0; k < main_ways().size(); ++k) {
            const Way& way = main_ways()[k];
            const Off off = off_by(scene, render_linear(as(scene, way)), truth);
            hold("rotation", way, "rel", off.rel, text("turned by ", m.turned_deg, " degrees"));
            hold("rotation", way, "bias", off.bias, text("turned by ", m.turned_deg, " degrees"));
            plot("error over angle", to_string(way), m.turned_deg, off.rel);
            seen[k].least = std::min(seen[k].least, off.rel);
            seen[k].most = std::max(seen[k].most, off.rel);
        }
    }
    for (std::size_t k = 0; k < main_ways().size(); ++k)
        hold("rotation", main_ways()[k], "most / least", seen[k].most / seen[k].least, text(steps, " angles"));
}

TEST(Laws, MovingByPartsOfAPixelLeavesTheErrorAlone) {
    const int steps = scale() > 1 ? 64 : 16;
    const std::vector<Shape> still = lamps_and_walls({32, 28}, 26);
    struct Seen {
        double least = 1e30, most = 0;
    };
    std::vector<Seen> seen(main_ways().size());
    for (int i = 0; i < steps; ++i) {
        Motion m;
        m.by = {double(i) / steps, 0.37 * i / steps};
        Scene scene = canvas(64, 56);
        scene.shapes = moved(still, m);
        const ImageF truth = truth_of(scene);
        for (std::size_t k = 0; k < main_ways().size(); ++k) {
            const Way& way = main_ways()[k];
            const Off off = off_by(scene, render_linear(as(scene, way)), truth);
            hold("translation", way, "rel", off.rel, text("moved by ", m.by.x, ", ", m.by.y, " px"));
            plot("error over position", to_string(way), m.by.x, off.rel);
            seen[k].least = std::min(seen[k].least, off.rel);
            seen[k].most = std::max(seen[k].most, off.rel);
        }
    }
    for (std::size_t k = 0; k < main_ways().size(); ++k)
        hold("translation", main_ways()[k], "most / least", seen[k].most / seen[k].least, text(steps, " positions"));
}

TEST(Laws, MirroredAndTurnedScenesGiveSuchPictures) {
    for (int i = 0; i < 2 * scale(); ++i) {
        Scene scene = i == 0 ? room(64, 48) : mild_scene(800 + std::uint64_t(i));
        std::erase_if(scene.shapes, [](const Shape& s) { return std::holds_alternative<Bitmap>(s.geometry); });
        scene.sky.gradient.clear();
        const int w = scene.canvas.width, h = scene.canvas.height;
        Motion mirror;
        mirror.mirrored = true;
        mirror.by = {double(w), 0};
        Motion turn;
        turn.turned_deg = 90;
        turn.by = {double(h), 0};
        Scene mirrored_scene = scene, turned_scene = scene;
        mirrored_scene.shapes = moved(scene.shapes, mirror);
        turned_scene.shapes = moved(scene.shapes, turn);
        turned_scene.canvas.width = h;
        turned_scene.canvas.height = w;
        for (const Way& way : main_ways()) {
            const ImageF plain = render_linear(as(scene, way));
            const std::string what = i == 0 ? "room" : text("mild scene ", 800 + i);
            hold("symmetry", way, "mirrored rel", apart(render_linear(as(mirrored_scene, way)), mirrored(plain)).rel, what);
            hold("symmetry", way, "turned rel", apart(render_linear(as(turned_scene, way)), turned(plain)).rel, what);
        }
    }
}

// Over a population: light made or lost. A single small lamp may be met badly; ten scenes may not lean.
TEST(Laws, NoLightIsMadeOrLost) {
    const int count = 12 * scale();
    std::vector<double> sum(all_ways().size(), 0.0);
    for (int i = 0; i < count; ++i) {
        const Scene scene = mild_scene(900 + std::uint64_t(i));
        const ImageF truth = truth_of(scene);
        for (std::size_t k = 0; k < all_ways().size(); ++k) {
            const Way& way = all_ways()[k];
            const ImageF picture = render_linear(as(scene, way));
            double a = 0, b = 0;
            for (std::size_t s = 0; s < truth.data.size(); ++s)
                if (std::isfinite(truth.data[s])) a += double(picture.data[s]), b += double(truth.data[s]);
            if (b <= 0) continue;
            sum[k] += (a / b - 1) / count;
            hold("energy", way, "bias of one scene", std::abs(a / b - 1), text("mild scene ", 900 + i));
        }
    }
    for (std::size_t k = 0; k < all_ways().size(); ++k) hold("energy", all_ways()[k], "mean bias", std::abs(sum[k]), text(count, " mild scenes"));
}

TEST(Laws, WhatHidesNeverBrightens) {
    for (int i = 0; i < 4 * scale(); ++i) {
        const Scene bare = i == 0 ? room() : mild_scene(1000 + std::uint64_t(i));
        Numbers numbers(40 + std::uint64_t(i));
        const Shape absorber = shape(Rect{{numbers.between(0.3, 0.7) * bare.canvas.width, numbers.between(0.3, 0.7) * bare.canvas.height},
                                          {numbers.between(1, 12), numbers.between(1, 12)}, numbers.between(0, 90), 0});
        // Below all others, so that it hides no lamp's own surface.
        Scene hidden = bare;
        hidden.shapes.insert(hidden.shapes.begin(), absorber);
        const ImageF free = truth_of(hidden);
        const Colour most = brightest_source(bare);
        const double peak = std::max({most.r, most.g, most.b});
        for (const Way& way : main_ways()) {
            const ImageF before = render_linear(as(bare, way));
            const ImageF after = render_linear(as(hidden, way));
            double brighter = 0;
            for (std::size_t k = 0; k < free.data.size(); ++k)
                if (std::isfinite(free.data[k])) brighter = std::max(brighter, double(after.data[k]) - double(before.data[k]));
            hold("monotonicity", way, "max of peak", brighter / peak, i == 0 ? "room" : text("mild scene ", 1000 + i));
        }
    }
}

TEST(Walls, AClosedWallOfOnePixelHoldsAllLightAtAnyAngle) {
    const int steps = scale() > 1 ? 90 : 10;
    for (int i = 0; i < steps; ++i) {
        Motion m;
        m.turned_deg = 90.0 * i / steps;
        m.centre = {32, 32};
        Scene scene = with(canvas(64, 64), {shape(Circle{{30.3, 33.2}, 4}, Colour(1)),
                                            shape(Polyline{{{16.4, 16.3}, {47.2, 16.3}, {47.2, 47.4}, {16.4, 47.4}}, 1, true})});
        scene.shapes = moved(scene.shapes, m);
        const ImageF truth = truth_of(scene);
        for (const Way& way : all_ways()) {
            const ImageF picture = render_linear(as(scene, way));
            double outside = 0;
            for (std::size_t k = 0; k < truth.data.size(); ++k)
                if (truth.data[k] == 0) outside = std::max(outside, double(picture.data[k]));
            hold("closed wall of 1 px", way, "brightest outside", outside, text("turned by ", m.turned_deg, " degrees"));
            plot("light behind a closed wall over angle", to_string(way), m.turned_deg, outside);
        }
    }
}

// A wall with a gap narrower than any cell or lattice: the beam behind it is there.
TEST(Walls, ABeamThroughANarrowGapIsNotMissed) {
    const int steps = scale() > 1 ? 36 : 4;
    for (const double gap : {0.3, 1.0, 3.0})
        for (const double lamp : {2.0, 12.0})
            for (int i = 0; i < steps; ++i) {
                Motion m;
                m.turned_deg = 360.0 * i / steps + 7;
                m.centre = {48, 48};
                Scene scene = canvas(96, 96);
                scene.shapes = moved({shape(Circle{{46.3, 16}, lamp}, Colour(1)), shape(Rect{{48 - 50 - 0.5 * gap, 36}, {100, 2}, 0, 0}),
                                      shape(Rect{{48 + 50 + 0.5 * gap, 36}, {100, 2}, 0, 0})}, m);
                const ImageF truth = truth_of(scene);
                double most = 0;
                Motion behind;  // its half of the view
                behind.turned_deg = -m.turned_deg;
                behind.centre = m.centre;
                const auto is_behind = [&](std::size_t k) {
                    return behind({double(k / 3 % 96) + 0.5, double(k / 3 / 96) + 0.5}).y > 37;
                };
                for (std::size_t k = 0; k < truth.data.size(); ++k)
                    if (std::isfinite(truth.data[k]) && is_behind(k)) most = std::max(most, double(truth.data[k]));
                for (const Way& way : all_ways()) {
                    const ImageF picture = render_linear(as(scene, way));
                    double lit = 0, missed = 0;
                    for (std::size_t k = 0; k < truth.data.size(); ++k) {
                        const double b = double(truth.data[k]);
                        if (!std::isfinite(b) || b < 0.02 * most || !is_behind(k)) continue;
                        ++lit;
                        if (double(picture.data[k]) < 0.1 * b) ++missed;
                    }
                    hold("narrow gaps", way, "share of the beam missed", lit > 0 ? missed / lit : 0,
                         text("gap of ", gap, " px, lamp of ", lamp, " px, turned by ", m.turned_deg, " degrees"));
                }
            }
}

// A wall between a lamp and the rest of the view, of every width and angle, on the grid and off it.
TEST(Walls, OfAnyWidthAndAngleCastTheirShadow) {
    const int steps = scale() > 1 ? 180 : 12;
    for (const double width : {0.1, 0.25, 0.5, 1.0, 2.0})
        for (const double place : {0.0, 0.31}) {
            std::vector<double> sum(main_ways().size(), 0.0);
            for (int i = 0; i < steps; ++i) {
                Motion m;
                m.turned_deg = 180.0 * i / steps;
                m.centre = {24, 24};
                m.by = Point(place, -0.7 * place);
                Scene scene = canvas(48, 48);
                scene.shapes = moved({shape(Circle{{24, 13}, 5}, Colour(1)), shape(Rect{{24, 24}, {26, width}, 0, 0})}, m);
                const ImageF truth = truth_of(scene);
                const std::string what = text("wall of ", width, " px at ", m.turned_deg, " degrees, ", place, " px off the grid");
                for (std::size_t k = 0; k < main_ways().size(); ++k) {
                    const Off off = off_by(scene, render_linear(as(scene, main_ways()[k])), truth);
                    hold("walls", main_ways()[k], "rel", off.rel, what);
                    hold("walls", main_ways()[k], "leak", off.leak, what);
                    sum[k] += off.rel / steps;
                }
            }
            for (std::size_t k = 0; k < main_ways().size(); ++k)
                if (place > 0) plot("error over wall width", to_string(main_ways()[k]), width, sum[k]);
        }
}

}  // namespace
}  // namespace penumbra::test
