// SPDX-License-Identifier: MIT
// The film on the host: exposure, tone curves against values computed apart from this program, sRGB, dither, tables.
#include <bit>
#include <cmath>

#include "core/film/encode.h"
#include "core/film/exposure.h"
#include "core/film/tonemap.h"
#include "test_scenes.h"

namespace penumbra {
namespace {

OutputSettings with_curve(const std::string& curve, const char* look = nullptr) {
    OutputSettings output;
    output.tonemap = curve;
    if (look != nullptr) output.look = look;
    return output;
}

int code(double linear) { return code_of(srgb_encoded(std::clamp(linear, 0.0, 1.0)), 255); }

// Of the published formulas, in double precision, red first: linear and code of 0.01 0.18 0.5 1 4 16 in grey, then the codes of
// (1,0,0), (10,1,.1) and (.8,.4,.1).
struct Golden {
    const char* curve;
    double linear[6];
    int codes[6];
    int colours[3][3];
};
constexpr Golden kGolden[] = {
    {"reinhard", {.00990, .15254, .33333, .50000, .80000, .94118}, {25, 109, 156, 188, 231, 248}, {{188, 0, 0}, {245, 188, 85}, {178, 146, 85}}},
    {"reinhard_extended", {.00991, .15426, .34375, .53125, 1.0, 1.88235}, {25, 109, 158, 193, 255, 255}, {{193, 0, 0}, {255, 193, 85}, {182, 147, 85}}},
    {"aces_narkowicz", {.00377, .26690, .61631, .80380, .97342, 1.01802}, {12, 141, 206, 232, 252, 255}, {{232, 0, 0}, {255, 232, 99}, {225, 194, 99}}},
    {"aces", {.00105, .10559, .37431, .61912, .90901, .98994}, {3, 91, 165, 206, 245, 254}, {{216, 0, 9}, {255, 224, 159}, {196, 150, 75}}},
    {"agx", {.00599, .21447, .42502, .58998, .86062, .99475}, {18, 128, 174, 202, 239, 254}, {{221, 56, 56}, {255, 212, 175}, {198, 167, 112}}},
    {"pbr_neutral", {.00063, .14000, .46000, .86909, .98326, .99627}, {2, 105, 181, 240, 253, 255}, {{241, 33, 33}, {254, 205, 199}, {226, 162, 69}}},
};
constexpr double kGreys[] = {0.01, 0.18, 0.5, 1, 4, 16};
const Colour kColours[] = {{1, 0, 0}, {10, 1, 0.1}, {0.8, 0.4, 0.1}};

TEST(HostTonemap, GoldenValues) {
    for (const Golden& golden : kGolden) {
        OutputSettings output = with_curve(golden.curve);
        for (std::size_t i = 0; i < 6; ++i) {
            const double red = tonemap(Colour(kGreys[i]), output).r;
            EXPECT_NEAR(red, golden.linear[i], 1.5e-5) << golden.curve << " of " << kGreys[i];
            EXPECT_EQ(code(red), golden.codes[i]) << golden.curve << " of " << kGreys[i];
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Colour out = tonemap(kColours[i], output);
            for (int c = 0; c < 3; ++c) EXPECT_EQ(code(out[c]), golden.colours[i][c]) << golden.curve << " colour " << i << " " << c;
        }
    }
}

TEST(HostTonemap, TheWhitePointIsWhite) {
    for (const double white : {1.0, 2.5, 11.0}) {
        OutputSettings output = with_curve("reinhard_extended");
        output.white = white;
        EXPECT_NEAR(tonemap(Colour(white), output).g, 1, 1e-12);
        EXPECT_LT(tonemap(Colour(white * 0.9), output).g, 1);
    }
}

TEST(HostTonemap, NeutralKeepsColoursBelowItsShoulder) {
    // Below 0.76 - 0.04, the specification only takes off the offset.
    const Colour out = tonemap({0.5, 0.3, 0.2}, with_curve("pbr_neutral"));
    EXPECT_NEAR(out.r, 0.46, 1e-12);
    EXPECT_NEAR(out.g, 0.26, 1e-12);
    EXPECT_NEAR(out.b, 0.16, 1e-12);
}

TEST(HostTonemap, LooksDoWhatTheirNamesSay) {
    const Colour grey(0.18), orange(0.8, 0.4, 0.1);
    const auto chroma = [](const Colour& c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); };
    const Colour base = tonemap(orange, with_curve("agx"));
    EXPECT_EQ(tonemap(orange, with_curve("agx", "none")), base);
    EXPECT_GT(chroma(tonemap(orange, with_curve("agx", "punchy"))), chroma(base));
    EXPECT_LT(luminance(tonemap(grey, with_curve("agx", "punchy"))), luminance(tonemap(grey, with_curve("agx"))));
    const Colour golden = tonemap(grey, with_curve("agx", "golden"));
    EXPECT_GT(golden.r, golden.g);
    EXPECT_GT(golden.g, golden.b);
}

// A grey value goes through inset and outset almost unchanged (their rows sum to 1 within 1e-4), so that the look of a grey can be
// computed by hand: v = contrast(log2 range), graded channel by channel, to the power 2.2.
TEST(HostTonemap, PunchyOfGreyByHand) {
    const double x = (std::log2(0.18) + 12.47393) / 16.5;
    const double v = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) + 0.4298 * x * x +
                     0.1191 * x - 0.00232;
    const double powered = std::pow(v, 1.35);
    const double expected = std::pow(v + 1.4 * (powered - v), 2.2);
    EXPECT_NEAR(tonemap(Colour(0.18), with_curve("agx", "punchy")).g, expected, 5e-4);
}

TEST(HostTonemap, NothingBreaksFarOut) {
    for (const Golden& golden : kGolden) {
        for (const double bright : {0.0, 1e-30, 1e9, 1e28, 1e300}) {
            const Colour out = tonemap({bright, 0, bright / 2}, with_curve(golden.curve));
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(out[c])) << golden.curve << " " << bright;
        }
    }
}

TEST(Film, All256CodesSurviveSrgb) {
    for (int c = 0; c < 256; ++c) EXPECT_EQ(code_of(srgb_encoded(srgb_decoded(c / 255.0)), 255), c);
    for (int c = 0; c < 65536; ++c) ASSERT_EQ(code_of(srgb_encoded(srgb_decoded(c / 65535.0)), 65535), c);
    EXPECT_NEAR(srgb_encoded(0.0031308), 0.04045, 1e-5);
    EXPECT_NEAR(srgb_encoded(0.5), 0.735357, 1e-6);
}

TEST(Film, CamerasExposeByTheBook) {
    // The sunny 16 rule: f/16 and 1/100 s at ISO 100 is EV 14.64; f/1 and 1 s is EV 0.
    EXPECT_NEAR(ev100_of({16, 0.01, 100}), 14.6439, 1e-4);
    EXPECT_NEAR(ev100_of({1, 1, 100}), 0, 1e-12);
    EXPECT_NEAR(ev100_of({1, 1, 400}), -2, 1e-12);
    EXPECT_NEAR(ev100_of({4, 1.0 / 60, 100}), std::log2(16.0 * 60), 1e-12);
    // 18 % grey under 100,000 lx at EV 15 (Filament's figure): L = E/pi * 0.18, times 1/(1.2 * 2^15), is 0.1457.
    EXPECT_NEAR(100'000 / M_PI * 0.18 * exposure_of_ev100(15), 0.1457, 1e-4);
    // A surface as bright as a meter thinks grey, L = 2^(EV - 3), comes out at 1 / (8 * 1.2) whatever the EV.
    for (const double ev : {-3.0, 0.0, 9.0}) EXPECT_NEAR(std::exp2(ev - 3) * exposure_of_ev100(ev), 1 / 9.6, 1e-12);
}

TEST(Film, CompensationIsInStops) {
    OutputSettings output;
    output.camera = Camera{2.8, 1.0 / 125, 200};
    const double factor = exposure_factor(output);
    output.exposure_ev = 1.5;
    EXPECT_NEAR(exposure_factor(output) / factor, std::exp2(1.5), 1e-9);
    EXPECT_NEAR(exposure_factor(OutputSettings{}), 1, 0);
}

std::optional<double> log_average(const std::vector<double>& values) {
    LogAverage average;
    for (const double v : values) average.add_to_mean(v);
    for (const double v : values) average.add(v);
    return average.value();
}

TEST(Film, LogAverageIsTheGeometricMeanOfWhatIsLit) {
    EXPECT_NEAR(*log_average({3, 3, 3}), 3, 1e-12);
    EXPECT_NEAR(*log_average({1, 4, 16}), 4, 1e-12);
    EXPECT_NEAR(*log_average({2, 0, 8, 0, 0}), 4, 1e-12);
    EXPECT_NEAR(*log_average({2, 1e-9, 8}), 4, 1e-12);
    EXPECT_FALSE(log_average({0, 0}));
    EXPECT_FALSE(log_average({}));
    OutputSettings output;
    output.auto_key = 0.18;
    EXPECT_NEAR(exposure_factor(output, 4.0), 0.045, 1e-12);
    EXPECT_EQ(exposure_factor(output, std::nullopt), 1);
}

TEST(Film, AutomaticExposureDoesNotKnowTheUnit) {
    const std::vector<double> values{0.3, 7, 0.001, 22, 1.7, 0};
    std::vector<double> brighter;
    for (const double v : values) brighter.push_back(v * 1e6);
    EXPECT_NEAR(*log_average(brighter) / *log_average(values), 1e6, 1);
}

TEST(Film, DitherIsTriangularAndHasNoBias) {
    // Mean and variance of code - value, over many pixels: 0 and 1/4 (1/12 of rounding, 2/12 of the noise).
    constexpr int kSide = 256;
    for (const double scaled : {0.0, 0.25, 0.7, 3.0, 77.4, 128.5, 254.2, 254.9, 255.0}) {
        double sum = 0, squares = 0;
        int low = 1000, high = -1000;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const PixelNoise noise = pixel_noise(x, y);
                const int code = dithered_code_of(scaled / 255, 255, noise.first[1], noise.second[1]);
                sum += code - scaled;
                squares += (code - scaled) * (code - scaled);
                low = std::min(low, code);
                high = std::max(high, code);
            }
        const double count = kSide * kSide;
        // Four standard deviations of the mean of that many.
        EXPECT_NEAR(sum / count, 0, 4 * 0.5 / kSide) << scaled;
        EXPECT_GE(low, 0);
        EXPECT_LE(high, 255);
        if (scaled == 0 || scaled == 255) {
            EXPECT_EQ(low, high);
        }
        if (scaled > 1 && scaled < 254) {
            EXPECT_NEAR(squares / count, 0.25, 0.01) << scaled;
            EXPECT_LE(high - low, 3);
        }
    }
}

TEST(Film, NoiseIsFlatAndDiffersByChannelAndPixel) {
    int bins[16] = {};
    int same = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const PixelNoise noise = pixel_noise(x, y);
            for (int c = 0; c < 3; ++c) ++bins[int(noise.first[c] * 16)];
            same += noise.first[0] == noise.first[1] || noise.first[0] == pixel_noise(x + 1, y).first[0];
        }
    for (const int count : bins) EXPECT_NEAR(count, 3 * 128 * 128 / 16, 4 * 56);
    EXPECT_LT(same, 10);
}

// A DDS of RGBA32F whose texel (r, g, b) is what `f` says of their places from 0 to 1.
template <class F>
Bytes dds(int side, F f) {
    Bytes file(148);
    const auto put = [&](std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i) file[at + i] = std::uint8_t(value >> (8 * i));
    };
    put(0, 0x20534444);
    put(12, std::uint32_t(side));
    put(16, std::uint32_t(side));
    put(24, std::uint32_t(side));
    put(84, 0x30315844);
    put(128, 2);
    for (int b = 0; b < side; ++b)
        for (int g = 0; g < side; ++g)
            for (int r = 0; r < side; ++r) {
                const Colour colour = f(Colour(r, g, b) / double(side - 1));
                for (int c = 0; c < 4; ++c) {
                    file.resize(file.size() + 4);
                    put(file.size() - 4, std::bit_cast<std::uint32_t>(c < 3 ? float(colour[c]) : 1.0f));
                }
            }
    return file;
}

TEST(ToneLut, ATableOfItsPlacesIsReinhard) {
    for (const int side : {2, 5, 48}) {
        const auto decoded = decode_tone_lut(dds(side, [](Colour c) { return c; }));
        ASSERT_TRUE(std::holds_alternative<ToneLut>(decoded)) << std::get<std::string>(decoded);
        const ToneLut& lut = std::get<ToneLut>(decoded);
        for (const Colour& colour : {Colour(0), Colour(0.18), Colour(1, 0, 0), Colour(10, 1, 0.1), Colour(1e9)}) {
            const Colour a = tonemap(colour, with_curve("tony"), &lut), b = tonemap(colour, with_curve("reinhard"));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6) << side;
        }
    }
}

TEST(ToneLut, RedRunsFastest) {
    const auto decoded = decode_tone_lut(dds(4, [](Colour c) { return Colour(c.b, c.r, c.g); }));
    const Colour out = std::get<ToneLut>(decoded).at({0.25, 0.5, 1});
    EXPECT_NEAR(out.r, 1, 1e-6);
    EXPECT_NEAR(out.g, 0.25, 1e-6);
    EXPECT_NEAR(out.b, 0.5, 1e-6);
}

TEST(ToneLut, ReadsSharedExponents) {
    Bytes file = dds(2, [](Colour) { return Colour(0); });
    file.resize(148 + 8 * 4);
    file[128] = 67;
    // 1 = 256 * 2^(16 - 15 - 9); green half of it, blue nothing.
    const std::uint32_t bits = 256u | 128u << 9 | 16u << 27;
    for (std::size_t i = 0; i < 8 * 4; ++i) file[148 + i] = std::uint8_t(bits >> (8 * (i % 4)));
    const auto decoded = decode_tone_lut(file);
    ASSERT_TRUE(std::holds_alternative<ToneLut>(decoded));
    EXPECT_EQ(std::get<ToneLut>(decoded).texels[7], glm::vec3(1, 0.5, 0));
}

TEST(ToneLut, RefusesWhatItIsNot) {
    const Bytes good = dds(3, [](Colour c) { return c; });
    const auto refused = [](const Bytes& file) { return std::holds_alternative<std::string>(decode_tone_lut(file)); };
    EXPECT_FALSE(refused(good));
    for (const std::size_t at : {std::size_t(0), std::size_t(12), std::size_t(24), std::size_t(84), std::size_t(128)}) {
        Bytes bad = good;
        bad[at] ^= 0x40;
        EXPECT_TRUE(refused(bad)) << at;
    }
    EXPECT_TRUE(refused(Bytes(good.begin(), good.end() - 1)));
    EXPECT_TRUE(refused({}));
    Bytes nan = good;
    for (std::size_t i = 148; i < 152; ++i) nan[i] = 0xff;
    EXPECT_TRUE(refused(nan));
}

}  // namespace
}  // namespace penumbra
