// SPDX-License-Identifier: MIT
// From radiance to the picture: tone curves, sRGB, exposure, edges, orientation, the linear picture.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/common.hpp>

#include "core/film/encode.h"
#include "core/film/exposure.h"
#include "core/film/tonemap.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

using Codes = std::array<int, 3>;

// A pixel of a scene that holds only a sky is that sky, through exposure and tone map.
Codes codes_of(Colour radiance, const std::string& tonemap, double exposure_ev = 0) {
    Scene scene = canvas(3, 2);
    scene.sky.radiance = radiance;
    scene.output.tonemap = tonemap;
    scene.output.exposure_ev = exposure_ev;
    const Image8 picture = render_display(scene);
    for (std::size_t i = 3; i < picture.data.size(); ++i) EXPECT_EQ(picture.data[i], picture.data[i % 3]);
    return {picture.data[0], picture.data[1], picture.data[2]};
}

// Codes computed apart from this program (double precision, the published formulas), red first. The row is
// 0.01 0.18 0.5 1 4 16 in grey, then (1,0,0), (10,1,.1) and (.8,.4,.1).
struct Curve {
    const char* name;
    std::array<int, 6> red_of_grey;
    std::array<Codes, 3> colours;
};
constexpr Curve kCurves[] = {
    {"reinhard", {25, 109, 156, 188, 231, 248}, {{{188, 0, 0}, {245, 188, 85}, {178, 146, 85}}}},
    {"reinhard_extended", {25, 109, 158, 193, 255, 255}, {{{193, 0, 0}, {255, 193, 85}, {182, 147, 85}}}},
    {"aces", {3, 91, 165, 206, 245, 254}, {{{216, 0, 9}, {255, 224, 159}, {196, 150, 75}}}},
    {"aces_narkowicz", {12, 141, 206, 232, 252, 255}, {{{232, 0, 0}, {255, 232, 99}, {225, 194, 99}}}},
    {"tony", {25, 109, 156, 188, 231, 248}, {{{188, 0, 0}, {245, 188, 85}, {178, 146, 85}}}},  // with the table of places
    {"agx", {18, 128, 174, 202, 239, 254}, {{{221, 56, 56}, {255, 212, 175}, {198, 167, 112}}}},
    {"pbr_neutral", {2, 105, 181, 240, 253, 255}, {{{241, 33, 33}, {254, 205, 199}, {226, 162, 69}}}},
};

TEST(Tonemap, GoldenValues) {
    const double greys[] = {0.01, 0.18, 0.5, 1, 4, 16};
    const Colour colours[] = {{1, 0, 0}, {10, 1, 0.1}, {0.8, 0.4, 0.1}};
    // One code: single precision may fall on the other side of a rounding edge.
    constexpr int kBound = 1;
    int off = 0;
    for (const Curve& curve : kCurves) {
        for (std::size_t i = 0; i < 6; ++i) {
            const int code = codes_of(Colour(greys[i]), curve.name)[0];
            EXPECT_NEAR(code, curve.red_of_grey[i], kBound) << curve.name << " of " << greys[i];
            off += code != curve.red_of_grey[i];
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Codes codes = codes_of(colours[i], curve.name);
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_NEAR(codes[c], curve.colours[i][c], kBound) << curve.name << " of colour " << i << " channel " << c;
                off += codes[c] != curve.colours[i][c];
            }
        }
    }
    // The device's own powers and logarithms: llvmpipe's round 2 of them the other way, an H200's 4.
    EXPECT_LE(off, shared_renderer().device().kind == "cpu" ? 2 : 5) << "of 105 codes";
}

TEST(Tonemap, HugeRadianceStaysWhite) {
    for (const Curve& curve : kCurves)
        for (const int code : codes_of(Colour(1e9), curve.name, 20)) EXPECT_GE(code, 254) << curve.name;
    for (const int code : codes_of(Colour(1e9), "none", 64)) EXPECT_EQ(code, 255);
}

TEST(Tonemap, BlackStaysBlack) {
    for (const Curve& curve : kCurves)
        for (const int code : codes_of(Colour(0), curve.name)) EXPECT_EQ(code, 0) << curve.name;
}

Scene sky_scene(const Colour& radiance, const std::string& tonemap) {
    Scene scene = canvas(3, 2);
    scene.sky.radiance = radiance;
    scene.output.tonemap = tonemap;
    return scene;
}

// The device's film against the host's, which is in double precision, over six decades.
TEST(Tonemap, TheDeviceDoesWhatTheHostDoes) {
    const ToneLut lut = table_of_places();
    int worst = 0, off = 0, count = 0;
    for (const char* curve : {"none", "reinhard", "reinhard_extended", "aces", "aces_narkowicz", "agx", "pbr_neutral", "tony"})
        for (const char* look : {"none", "golden", "punchy"}) {
            if (std::string(curve) != "agx" && std::string(look) != "none") continue;
            Numbers random(11);
            for (int i = 0; i < 30; ++i) {
                const auto channel = [&] { return std::pow(10.0, random.between(-4, 2)); };
                Scene scene = sky_scene({channel(), channel(), channel()}, curve);
                if (std::string(curve) == "agx") scene.output.look = look;
                if (std::string(curve) == "reinhard_extended") scene.output.white = random.between(1, 20);
                const Colour mapped = glm::clamp(tonemap(scene.sky.radiance, scene.output, &lut), 0.0, 1.0);
                const Image16 picture = render_display16(scene);
                for (int c = 0; c < 3; ++c) {
                    const int code = code_of(srgb_encoded(mapped[c]), 65535);
                    const int difference = std::abs(code - picture.at(1, 1)[c]);
                    EXPECT_LE(difference, 8) << curve << " " << look << " of " << scene.sky.radiance[c];
                    worst = std::max(worst, difference);
                    off += difference > 3;
                    ++count;
                }
            }
        }
    std::printf("film: of %d codes of 16 bits %d are more than 3 off, the worst is %d off\n", count, off, worst);
}

TEST(Srgb, SixteenBitsAreExactToACode) {
    Numbers random(5);
    for (int i = 0; i < 200; ++i) {
        const double value = std::pow(random.next(), 3);
        const Image16 picture = render_display16(sky_scene(Colour(value), "none"));
        EXPECT_NEAR(picture.at(0, 0)[1], code_of(srgb_encoded(double(float(value))), 65535), 2) << value;
    }
    EXPECT_EQ(render_display16(sky_scene(Colour(1), "none")).at(0, 0)[0], 65535);
    EXPECT_EQ(render_display16(sky_scene(Colour(0), "none")).at(0, 0)[0], 0);
}

TEST(Dither, IsThatOfTheHostPixelByPixel) {
    Scene scene = canvas(70, 37);
    scene.sky.radiance = {0.2, 0.00003, 3};
    scene.output.dither = Dither::triangular;
    const Image8 picture = render_display(scene);
    const Image8 again = render_display(scene);
    EXPECT_EQ(picture.data, again.data);
    int differing = 0;
    double sum = 0;
    for (int y = 0; y < 37; ++y)
        for (int x = 0; x < 70; ++x) {
            const PixelNoise noise = pixel_noise(x, y);
            for (int c = 0; c < 3; ++c) {
                const double value = srgb_encoded(std::min(scene.sky.radiance[c], 1.0));
                const int expected = dithered_code_of(value, 255, noise.first[c], noise.second[c]);
                EXPECT_NEAR(picture.at(x, y)[c], expected, 1);
                differing += picture.at(x, y)[c] != expected;
            }
            sum += picture.at(x, y)[0];
        }
    EXPECT_LT(differing, 10) << "of 7770 codes, where rounding falls on the other side";
    EXPECT_NEAR(sum / (70 * 37), 255 * srgb_encoded(0.2), 0.05);
}

TEST(Dither, LeavesBlackBlackAndWhiteWhite) {
    for (const double value : {0.0, 1.0, 7.0}) {
        Scene scene = sky_scene(Colour(value), "none");
        scene.output.dither = Dither::triangular;
        for (const std::uint8_t code : render_display(scene).data) EXPECT_EQ(code, value > 0 ? 255 : 0);
    }
}

TEST(Srgb, All256CodesSurvive) {
    // A ramp of bitmaps would do as well, but a sky goes the whole way through the cascades.
    for (int code = 0; code < 256; code += 3) {
        const Codes wanted = {code, std::min(code + 1, 255), std::min(code + 2, 255)};
        const Colour sky(srgb_decode(wanted[0]), srgb_decode(wanted[1]), srgb_decode(wanted[2]));
        EXPECT_EQ(codes_of(sky, "none"), wanted);
    }
}

TEST(Srgb, ClipsAtWhite) { EXPECT_EQ(codes_of({1.5, 0.9999, 2}, "none"), (Codes{255, 255, 255})); }

TEST(Exposure, IsAPowerOfTwoBeforeTheToneMap) {
    for (const char* tonemap : {"none", "agx"})
        for (const double ev : {-3.0, -0.5, 1.0, 4.25}) {
            const Colour sky(0.03, 0.2, 0.011);
            const Codes exposed = codes_of(sky, tonemap, ev);
            const Codes brighter = codes_of(sky * std::exp2(ev), tonemap);
            for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(exposed[c], brighter[c], 1) << tonemap << " " << ev;
        }
    EXPECT_EQ(codes_of(Colour(0.18), "none", 1)[0], srgb_encode(0.36));
}

TEST(Exposure, OfACameraIsItsFactor) {
    Scene scene = sky_scene(Colour(0.3), "none");
    scene.output.camera = Camera{2, 0.25, 200};  // EV100 3
    EXPECT_EQ(render_display(scene).data[0], srgb_encode(0.3 / (1.2 * 8)));
    scene.output.exposure_ev = 2;
    EXPECT_EQ(render_display(scene).data[0], srgb_encode(4 * 0.3 / (1.2 * 8)));
}

TEST(Exposure, AutomaticMakesAnEvenSkyTheKey) {
    for (const double radiance : {1e-6, 0.4, 3e5}) {
        Scene scene = sky_scene(Colour(radiance), "none");
        scene.output.auto_key = kDefaultKey;
        EXPECT_EQ(render_display(scene).data[0], srgb_encode(0.18)) << radiance;
    }
    Scene dark = sky_scene(Colour(0), "none");
    dark.output.auto_key = kDefaultKey;
    EXPECT_EQ(render_display(dark).data[0], 0);
}

// The factor by hand, from the linear picture; a lamp's own pixels are solid and do not count.
TEST(Exposure, AutomaticIsTheLogAverageOfFreePixels) {
    Scene scene = with(canvas(40, 30), {shape(Circle{{12.3, 14.2}, 5}, {900, 800, 100}), shape(Rect{{30.1, 15.2}, {4, 20}, 0, 0})});
    scene.sky.radiance = Colour(0.01);
    const ImageF linear = render_linear(scene);
    LogAverage average;
    const auto each_free = [&](auto visit) {
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                const bool lamp = std::hypot(x + 0.5 - 12.3, y + 0.5 - 14.2) <= 5;
                const bool wall = std::abs(x + 0.5 - 30.1) <= 2 && std::abs(y + 0.5 - 15.2) <= 10;
                const float* p = linear.at(x, y);
                if (!lamp && !wall) visit(luminance({p[0], p[1], p[2]}));
            }
    };
    each_free([&](double y) { average.add_to_mean(y); });
    each_free([&](double y) { average.add(y); });
    scene.output.auto_key = 0.1;
    const Image8 picture = render_display(scene);
    for (const int x : {1, 22, 25, 38}) {
        const double expected = std::min(double(linear.at(x, 3)[0]) * 0.1 / *average.value(), 1.0);
        EXPECT_NEAR(picture.at(x, 3)[0], srgb_encode(expected), 1) << x;
    }
}

TEST(Exposure, LeavesTheLinearPictureAlone) {
    Scene scene = canvas(4, 3);
    scene.sky.radiance = Colour(0.4);
    scene.output.exposure_ev = 3;
    scene.output.tonemap = "agx";
    EXPECT_NEAR(mean(render_linear(scene)), 0.4, 1e-6);
}

TEST(Linear, FloorAlbedoCountsOnFreePixelsAndEmissionOnSolidOnes) {
    Scene scene = with(canvas(24, 16), {shape(Circle{{8.2, 8.1}, 4}, {2, 3, 4}), shape(Rect{{18.1, 8.2}, {4, 6}, 0, 0})});
    const ImageF white = render_linear(scene);
    scene.canvas.floor_albedo = {0.5, 0.25, 0};
    const ImageF tinted = render_linear(scene);
    int solid = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) {
            const bool lamp = std::hypot(x + 0.5 - 8.2, y + 0.5 - 8.1) <= 4;
            const bool wall = std::abs(x + 0.5 - 18.1) <= 2 && std::abs(y + 0.5 - 8.2) <= 3;
            const float* a = white.at(x, y);
            const float* b = tinted.at(x, y);
            if (lamp || wall) {
                ++solid;
                for (int c = 0; c < 3; ++c) {
                    EXPECT_EQ(a[c], lamp ? float(2 + c) : 0.0f);
                    EXPECT_EQ(b[c], a[c]) << "the floor's albedo is not the shape's";
                }
            } else {
                EXPECT_FLOAT_EQ(b[0], 0.5f * a[0]);
                EXPECT_FLOAT_EQ(b[1], 0.25f * a[1]);
                EXPECT_EQ(b[2], 0);
            }
        }
    EXPECT_GT(solid, 60);
}

TEST(Linear, IsNeverAntialiased) {
    Scene scene = with(canvas(24, 16), {shape(Circle{{8.2, 8.1}, 4}, {2, 3, 4})});
    scene.output.antialias = true;
    const ImageF with_antialias = render_linear(scene);
    scene.output.antialias = false;
    EXPECT_EQ(difference(with_antialias, render_linear(scene)).max, 0);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x)
            if (std::hypot(x + 0.5 - 8.2, y + 0.5 - 8.1) > 4) {
                EXPECT_LT(with_antialias.at(x, y)[0], 1.6f) << "a free pixel holds some of the lamp's emission";
            }
}

// A grey wall under an even sky: the free pixel beside it sees half the sky and more; the wall shows its albedo times that, to its very
// middle, and nothing of the floor's albedo. A lamp's emission stays as it is.
TEST(Solids, LitOnesShowAlbedoTimesTheLightBesideThem) {
    Shape wall = shape(Rect{{12.2, 8.1}, {9, 30}, 0, 0});
    wall.albedo = {0.5, 0.25, 0};
    Shape lamp = shape(Circle{{30.1, 8.2}, 3}, {4, 3, 2});
    lamp.albedo = Colour(0.1);
    Scene scene = with(canvas(40, 16), {wall, lamp});
    scene.sky.radiance = Colour(1);
    scene.canvas.floor_albedo = {0.3, 0.3, 0.3};
    const ImageF plain = render_linear(scene);
    scene.output.solids = Solids::lit;
    const ImageF lit = render_linear(scene);
    const Image8 shown = render_display(scene);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 40; ++x) {
            const bool in_wall = std::abs(x + 0.5 - 12.2) <= 4.5;
            const bool in_lamp = std::hypot(x + 0.5 - 30.1, y + 0.5 - 8.2) <= 3;
            if (!in_wall && !in_lamp) {
                for (int c = 0; c < 3; ++c) EXPECT_EQ(lit.at(x, y)[c], plain.at(x, y)[c]);
                // The wall covers 0.3 of column 7, with its own light and not with darkness.
                const double red = double(plain.at(x, y)[0]);
                if (x == 7) {
                    EXPECT_NEAR(shown.at(x, y)[0], srgb_encode(0.7 * red + 0.3 * 0.5 / 0.3 * red), 1) << y;
                }
            } else if (in_wall) {
                // Columns 8 to 16 are solid: the nearest free ones are 7 and 17.
                const float* beside = plain.at(x <= 12 ? 7 : 17, y);
                EXPECT_NEAR(lit.at(x, y)[0], 0.5 / 0.3 * double(beside[0]), x == 12 ? 0.2 : 1e-5) << x << " " << y;
                EXPECT_NEAR(lit.at(x, y)[1], 0.25 / 0.3 * double(beside[1]), x == 12 ? 0.1 : 1e-5) << x << " " << y;
                EXPECT_EQ(lit.at(x, y)[2], 0);
                if (x > 8 && x < 16) {
                    EXPECT_NEAR(shown.at(x, y)[0], srgb_encode(double(lit.at(x, y)[0])), 1);
                }
            } else {
                EXPECT_GT(lit.at(x, y)[0], 4.02f);
                EXPECT_LT(lit.at(x, y)[0], 4.4f);
            }
        }
}

// A part of the canvas is the crop of the whole, though both ask for what lies outside of it.
TEST(Solids, LitAndAutomaticPicturesOfARegionAreItsCrop) {
    Shape wall = shape(Rect{{20.2, 15.1}, {22, 18}, 0, 0});
    wall.albedo = {0.5, 0.25, 0.7};
    Scene scene = with(canvas(60, 40), {wall, shape(Circle{{52.1, 8.2}, 4}, {9, 8, 7})});
    scene.sky.radiance = Colour(0.1);
    scene.lights.push_back(PointLight{{8.2, 33.1}, Colour(4)});
    scene.output.solids = Solids::lit;
    scene.output.auto_key = kDefaultKey;
    const Image8 whole = render_display(scene);
    scene.canvas.region = PixelRect{14, 10, 12, 9};  // inside the wall
    const Image8 part = render_display(scene);
    ASSERT_EQ(part.width, 12);
    ASSERT_EQ(part.height, 9);
    int bright = 0;
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 12; ++x)
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(part.at(x, y)[c], whole.at(x + 14, y + 10)[c], 1);
                bright += part.at(x, y)[c] > 10;
            }
    EXPECT_GT(bright, 200);
}

// Lights without a size count: far from everything else, the wall beside a lamp shows albedo times what the floor gets.
TEST(Solids, LitOnesShowPointLightsToo) {
    Shape wall = shape(Rect{{20.2, 15.1}, {10, 200}, 0, 0});
    wall.albedo = Colour(0.5);
    Scene scene = with(canvas(40, 30), {wall});
    scene.lights.push_back(PointLight{{5.2, 15.1}, Colour(20)});
    scene.output.solids = Solids::lit;
    const ImageF lit = render_linear(scene);
    EXPECT_GT(lit.at(14, 15)[0], 0.3f);
    EXPECT_NEAR(lit.at(16, 15)[0], 0.5 * double(lit.at(14, 15)[0]), 1e-5);
}

TEST(Solids, LitBitmapsShowTheirOwnColours) {
    auto texels = std::make_shared<Texels>(Texels{2, 1, {255, 0, 0, 255, 0, 188, 0, 255}});
    Shape bitmap = shape(Bitmap{texels, {4, 4}, {8, 4}, 0.5, 0.5, true});
    Scene scene = with(canvas(16, 12), {bitmap});
    scene.sky.radiance = Colour(1);
    scene.output.solids = Solids::lit;
    const ImageF lit = render_linear(scene);
    EXPECT_NEAR(lit.at(5, 4)[0], 0.5 * double(lit.at(5, 3)[0]), 1e-5);
    EXPECT_EQ(lit.at(5, 4)[1], 0);
    EXPECT_NEAR(lit.at(10, 4)[1], 0.5 * srgb_decode(188) * double(lit.at(10, 3)[1]), 1e-5);
    scene.shapes[0].geometry = Bitmap{texels, {4, 4}, {8, 4}, 1, 0.5, false};
    EXPECT_EQ(render_linear(scene).at(5, 4)[0], 1);
}

TEST(Solids, ACanvasThatIsAllSolidIsBlackWithoutLight) {
    Shape wall = shape(Rect{{8, 6}, {100, 100}, 0, 0});
    wall.albedo = Colour(1);
    Scene scene = with(canvas(16, 12), {wall});
    scene.sky.radiance = Colour(1);
    scene.output.solids = Solids::lit;
    EXPECT_EQ(largest(render_linear(scene)), 0);
}

TEST(Picture, TheFirstRowIsTheTop) {
    // One lamp at the top left; the brightest pixel must be there, in both formats.
    Scene scene = with(canvas(30, 20), {shape(Circle{{2.6, 1.7}, 1.6}, Colour(1))});
    const ImageF linear = render_linear(scene);
    EXPECT_EQ(linear.at(2, 1)[0], 1);
    EXPECT_LT(linear.at(2, 18)[0], 0.2f);
    EXPECT_LT(linear.at(27, 1)[0], 0.2f);
    const Image8 display = render_display(scene);
    EXPECT_EQ(display.at(2, 1)[0], 255);
    EXPECT_LT(display.at(2, 18)[0], 128);
    EXPECT_LT(display.at(27, 1)[0], 128);
}

TEST(Edges, AreMixedByCoverage) {
    // A dim red half plane under a green sky; its edge runs at x = 10 + f.
    for (const double f : {0.1, 0.3, 0.7, 0.9}) {
        Scene scene = with(canvas(20, 9), {shape(Rect{{-90 + f, 4.5}, {200, 400}, 0, 0}, {0.25, 0, 0})});
        scene.sky.radiance = {0, 1, 0};
        const Image8 smooth = render_display(scene);
        const ImageF linear = render_linear(scene);
        EXPECT_GT(linear.at(11, 4)[1], 0.3f);
        EXPECT_EQ(smooth.at(9, 4)[0], srgb_encode(0.25));
        EXPECT_EQ(smooth.at(9, 4)[1], 0);
        // The floor's share: of the pixel itself where its centre is free, else of its free neighbours.
        const float* floor = linear.at(f < 0.5 ? 10 : 11, 4);
        const std::uint8_t* edge = smooth.at(10, 4);
        EXPECT_NEAR(edge[0], srgb_encode(0.25 * f + double(floor[0]) * (1 - f)), 1) << f;
        EXPECT_NEAR(edge[1], srgb_encode(double(floor[1]) * (1 - f)), 1) << f;
        scene.output.antialias = false;
        const Image8 hard = render_display(scene);
        EXPECT_EQ(hard.at(10, 4)[0], f < 0.5 ? srgb_encode(double(floor[0])) : srgb_encode(0.25)) << f;
        EXPECT_EQ(hard.at(10, 4)[1], f < 0.5 ? srgb_encode(double(floor[1])) : 0) << f;
    }
}

TEST(Edges, NothingDarkRoundABlackDiscAndNothingBrightFromInside) {
    // Under a uniform sky, a free pixel beside a convex black shape sees at least half the sky. Four directions a pixel
    // that merge sixteen: rays near the tangent may be taken for hits, a few in a hundred.
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) {
        const Circle disc{{24.3, 20.2}, 9.4};
        Scene black = with(canvas(48, 40), {shape(disc)});
        black.sky.radiance = Colour(1);
        black.render.quality = quality;
        const ImageF dark = render_linear(black);
        // A black sky and a lit disc: beside it half of all directions are lit, never more.
        Scene lamp = with(canvas(48, 40), {shape(disc, Colour(1))});
        lamp.render.quality = quality;
        const ImageF lit = render_linear(lamp);
        double darkest = 1;
        double brightest = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 48; ++x) {
                const double d = std::hypot(x + 0.5 - disc.center.x, y + 0.5 - disc.center.y) - disc.radius;
                if (d <= 0) continue;
                darkest = std::min(darkest, double(dark.at(x, y)[0]));
                brightest = std::max(brightest, double(lit.at(x, y)[0]));
            }
        RecordProperty("darkest_" + std::to_string(int(quality)), std::to_string(darkest));
        RecordProperty("brightest_" + std::to_string(int(quality)), std::to_string(brightest));
        std::printf("quality %d: beside a black disc at least %.4f of the sky, beside a lamp at most %.4f of it\n", int(quality), darkest, brightest);
        EXPECT_GE(darkest, 0.45);
        EXPECT_LE(brightest, 0.55);
    }
}

}  // namespace
}  // namespace penumbra::test
