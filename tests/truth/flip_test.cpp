// SPDX-License-Identifier: MIT
#include "core/compare/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace penumbra {
namespace {

Image8 flat(int size, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    Image8 image(size, size, 3);
    for (int i = 0; i < size * size; ++i) {
        image.data[std::size_t(3 * i)] = r;
        image.data[std::size_t(3 * i + 1)] = g;
        image.data[std::size_t(3 * i + 2)] = b;
    }
    return image;
}

Image8 noise(int width, int height, unsigned seed, int amount) {
    Image8 image(width, height, 3);
    std::mt19937 random(seed);
    for (int i = 0; i < width * height * 3; ++i) {
        image.data[std::size_t(i)] =
            std::uint8_t(128 + int(random() % unsigned(2 * amount + 1)) - amount);
    }
    return image;
}

double flip_of(const Image8& a, const Image8& b, double ppd = 67) {
    return std::get<Flip>(flip(a, b, {ppd})).mean;
}

TEST(Flip, EqualPicturesHaveNone) {
    EXPECT_EQ(flip_of(noise(40, 30, 1, 100), noise(40, 30, 1, 100)), 0);
    EXPECT_EQ(flip_of(flat(8, 1, 2, 3), flat(8, 1, 2, 3)), 0);
}

// Flat pictures have no features and filtering does not change them: the colour pipeline alone,
// by hand. HyAB of black and white is their difference in lightness, 100.
TEST(Flip, BlackAgainstWhiteByHand) {
    // Green against blue, Hunt-adjusted L*a*b* (from the primaries' XYZ with D65):
    // green L 87.735, a -86.183, b 83.180; blue L 32.301, a 79.188, b -107.860.
    const double green[3] = {87.7347, 0.877347 * -86.1827, 0.877347 * 83.1793};
    const double blue[3] = {32.2970, 0.322970 * 79.1875, 0.322970 * -107.8602};
    const double largest = std::pow(
        std::abs(green[0] - blue[0]) + std::hypot(green[1] - blue[1], green[2] - blue[2]), 0.7);
    const double colour = std::pow(100, 0.7);
    const double knee = 0.4 * largest;
    ASSERT_GT(colour, knee);
    const double expected = 0.95 + (colour - knee) / (largest - knee) * 0.05;
    EXPECT_NEAR(flip_of(flat(24, 0, 0, 0), flat(24, 255, 255, 255)), expected, 2e-4);
}

TEST(Flip, GreenAgainstBlueIsTheLargestDifference) {
    EXPECT_NEAR(flip_of(flat(24, 0, 255, 0), flat(24, 0, 0, 255)), 1, 1e-6);
}

TEST(Flip, SmallFlatDifferenceByHand) {
    // Greys 128 and 129: only lightness differs.
    const auto lightness = [](double v) {
        const double y = std::pow((v / 255 + 0.055) / 1.055, 2.4);
        return 116 * std::cbrt(y) - 16;
    };
    const double green[3] = {87.7347, 0.877347 * -86.1827, 0.877347 * 83.1793};
    const double blue[3] = {32.2970, 0.322970 * 79.1875, 0.322970 * -107.8602};
    const double largest = std::pow(
        std::abs(green[0] - blue[0]) + std::hypot(green[1] - blue[1], green[2] - blue[2]), 0.7);
    const double expected = std::pow(lightness(129) - lightness(128), 0.7) * 0.95 / (0.4 * largest);
    EXPECT_NEAR(flip_of(flat(16, 128, 128, 128), flat(16, 129, 129, 129)), expected, 1e-5);
}

TEST(Flip, IsSymmetric) {
    const Image8 a = noise(33, 21, 1, 90), b = noise(33, 21, 2, 40);
    EXPECT_NEAR(flip_of(a, b), flip_of(b, a), 1e-12);
    EXPECT_GT(flip_of(a, b), 0.05);
}

TEST(Flip, GrowsWithTheDifference) {
    const Image8 base = flat(24, 100, 100, 100);
    double before = 0;
    for (const int step : {1, 4, 16, 64, 155}) {
        const auto v = std::uint8_t(100 + step);
        const double found = flip_of(base, flat(24, v, v, v));
        EXPECT_GT(found, before);
        before = found;
    }
    EXPECT_LE(before, 1);
    before = 0;
    for (const int amount : {5, 20, 60, 120}) {
        const double found = flip_of(flat(40, 128, 128, 128), noise(40, 40, 3, amount));
        EXPECT_GT(found, before);
        before = found;
    }
}

TEST(Flip, FarAwayFineNoiseFades) {
    const Image8 base = flat(64, 128, 128, 128), noisy = noise(64, 64, 3, 60);
    EXPECT_LT(flip_of(base, noisy, 200), flip_of(base, noisy, 20));
}

TEST(Flip, AnEdgeIsSeenMoreThanItsColourAlone) {
    // A line on grey: at the line the feature term raises the colour term.
    Image8 base = flat(41, 128, 128, 128), line = base;
    for (int y = 0; y < 41; ++y) {
        for (int c = 0; c < 3; ++c) line.at(20, y)[c] = 200;
    }
    const Flip result = std::get<Flip>(flip(base, line));
    EXPECT_GT(*result.map.at(20, 20), 0.3f);
    EXPECT_LT(*result.map.at(0, 20), 0.05f);
    for (int x = 0; x <= 20; ++x)
        EXPECT_NEAR(*result.map.at(x, 20), *result.map.at(40 - x, 20), 1e-5);
    for (int y = 0; y < 41; ++y) EXPECT_NEAR(*result.map.at(20, y), *result.map.at(20, 20), 1e-5);
}

TEST(Flip, GreyCountsAsEqualChannelsAndSizesMustAgree) {
    Image8 grey(9, 9, 1, 77), rgba(9, 9, 4, 77);
    EXPECT_EQ(flip_of(grey, rgba), 0);
    EXPECT_EQ(std::get<Problem>(flip(grey, Image8(8, 9, 1))).code, "size_differs");
}

}  // namespace
}  // namespace penumbra
