// SPDX-License-Identifier: MIT
#include "core/compare/error_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/compare/difference_picture.h"

namespace penumbra {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ImageF grey(std::vector<float> values) {
    ImageF image(int(values.size()), 1, 1);
    image.data = std::move(values);
    return image;
}

ErrorFigures figures(const ImageF& a, const ImageF& b) {
    return std::get<ErrorFigures>(error_figures(a, b));
}

TEST(ErrorFigures, ByHand) {
    // mean b = 2; differences 1, 0, 2, 1.
    const auto f = figures(grey({2, 2, 1, 4}), grey({1, 2, 3, 2 + 1e-7f + 1}));
    EXPECT_EQ(f.count, 4u);
    const double last = double(2 + 1e-7f + 1);
    const double mean = (6 + last) / 4;
    EXPECT_DOUBLE_EQ(*f.mean_truth, mean);
    EXPECT_NEAR(*f.rmse, std::sqrt((1 + 0 + 4 + (4 - last) * (4 - last)) / 4), 1e-12);
    EXPECT_NEAR(*f.nrmse, *f.rmse / mean, 1e-12);
    EXPECT_NEAR(*f.max_abs, 2, 1e-12);
    EXPECT_NEAR(*f.max, 2 / mean, 1e-12);
    EXPECT_NEAR(*f.bias, (9.0 / 4 - mean) / mean, 1e-12);
    EXPECT_NEAR(
        *f.rel,
        (1 / (1 + 0.05 * mean) + 2 / (3 + 0.05 * mean) + (4 - last) / (last + 0.05 * mean)) / 4,
        1e-12);
    EXPECT_FALSE(f.leak.has_value());
}

TEST(ErrorFigures, PercentileInterpolatesBetweenRanks) {
    std::vector<float> a, b;
    for (int i = 0; i < 11; ++i) {
        a.push_back(float(1 + (i * 7) % 11));  // differences 0 to 10, shuffled
        b.push_back(1);
    }
    EXPECT_NEAR(*figures(grey(a), grey(b)).p99, 9.9, 1e-12);
    EXPECT_NEAR(*figures(grey({3}), grey({1})).p99, 2, 1e-12);
}

TEST(ErrorFigures, Leak) {
    // Mean of the truth 1: samples below 1e-6 are dark; the picture has 0.5 and 0.1 there.
    const auto f = figures(grey({2, 2, 0.5f, 0.1f}), grey({2, 2, 0, 1e-7f}));
    EXPECT_NEAR(*f.leak, 0.3 / ((4 + double(1e-7f)) / 4), 1e-8);
}

TEST(ErrorFigures, NanInTheTruthIsLeftOutNanInThePictureIsCounted) {
    const auto f = figures(grey({1, 100, kNan, kNan, std::numeric_limits<float>::infinity()}),
                           grey({1, kNan, 1, kNan, 1}));
    EXPECT_EQ(f.count, 1u);
    EXPECT_EQ(f.nan_only_a, 2u);
    EXPECT_EQ(*f.nrmse, 0);
    const auto none = figures(grey({kNan}), grey({1}));
    EXPECT_EQ(none.count, 0u);
    EXPECT_FALSE(none.rmse.has_value());
    EXPECT_FALSE(none.mean_truth.has_value());
}

TEST(ErrorFigures, ABlackTruthHasNoRelativeFigures) {
    const auto f = figures(grey({0.5f, 0}), grey({0, 0}));
    EXPECT_FALSE(f.nrmse || f.rel || f.p99 || f.max || f.bias || f.leak);
    EXPECT_NEAR(*f.rmse, std::sqrt(0.125), 1e-12);
    EXPECT_EQ(*f.max_abs, 0.5);
}

TEST(ErrorFigures, EveryChannelIsASample) {
    ImageF a(1, 2, 3), b(1, 2, 3);
    a.data = {1, 2, 3, 4, 5, 6};
    b.data = {1, 2, 3, 4, 5, 3};
    EXPECT_EQ(figures(a, b).count, 6u);
    EXPECT_NEAR(*figures(a, b).bias, 3.0 / 18, 1e-12);
    ImageF with_alpha(1, 2, 4);
    with_alpha.data = {1, 2, 3, 99, 4, 5, 3, 99};
    EXPECT_EQ(*figures(with_alpha, b).rmse, 0);
}

TEST(ErrorFigures, SizesMustAgree) {
    EXPECT_EQ(std::get<Problem>(error_figures(ImageF(2, 1, 3), ImageF(1, 2, 3))).code,
              "size_differs");
    EXPECT_EQ(std::get<Problem>(error_figures(ImageF(2, 1, 1), ImageF(2, 1, 3))).code,
              "channels_differ");
    EXPECT_EQ(std::get<Problem>(pixel_figures(Image8(2, 1, 1), Image8(1, 1, 1))).code,
              "size_differs");
}

TEST(PixelFigures, ByHand) {
    Image8 a(2, 2, 3), b(2, 2, 3);
    b.data = {0, 0, 0, 10, 0, 0, 0, 2, 4, 0, 0, 0};
    const auto f = std::get<PixelFigures>(pixel_figures(a, b));
    EXPECT_EQ(f.largest, 10);
    EXPECT_EQ(f.differing, 2u);
    EXPECT_EQ(f.pixels, 4u);
    EXPECT_NEAR(f.mean, 16.0 / 12, 1e-12);
    EXPECT_NEAR(*f.psnr_db, 10 * std::log10(255.0 * 255 * 12 / 120), 1e-12);
    EXPECT_FALSE(std::get<PixelFigures>(pixel_figures(a, a)).psnr_db.has_value());
    // Grey against RGB, RGB against RGBA.
    Image8 one(1, 1, 1, 7), three(1, 1, 3, 7), four(1, 1, 4, 7);
    EXPECT_EQ(std::get<PixelFigures>(pixel_figures(one, three)).largest, 0);
    EXPECT_EQ(std::get<PixelFigures>(pixel_figures(three, four)).largest, 248);
}

TEST(DifferencePicture, RedIsTooBrightBlueTooDark) {
    ImageF a(5, 1, 3, 1), b(5, 1, 3, 1);
    for (int c = 0; c < 3; ++c) {
        a.at(1, 0)[c] = 3;
        a.at(2, 0)[c] = 0;
        b.at(3, 0)[c] = kNan;
        a.at(4, 0)[c] = kNan;
    }
    const auto picture = std::get<Image8>(signed_picture(a, b));
    EXPECT_EQ(*picture.at(0, 0), 255);
    EXPECT_GT(picture.at(1, 0)[0], picture.at(1, 0)[2]);
    EXPECT_LT(picture.at(2, 0)[0], picture.at(2, 0)[2]);
    EXPECT_EQ(picture.at(3, 0)[0], 128);
    EXPECT_GT(picture.at(4, 0)[1], picture.at(4, 0)[0]);
    EXPECT_EQ(picture.at(4, 0)[0], 0);
    EXPECT_TRUE(std::holds_alternative<Problem>(signed_picture(ImageF(1, 1, 3), b)));
}

TEST(DifferencePicture, HeatGetsLighter) {
    ImageF map(101, 1, 1);
    for (int i = 0; i <= 100; ++i) map.data[std::size_t(i)] = float(i) / 100;
    const Image8 picture = heat_picture(map);
    double before = -1;
    for (int i = 0; i <= 100; ++i) {
        const std::uint8_t* p = picture.at(i, 0);
        const double luma = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        EXPECT_GE(luma, before - 1);
        before = luma;
    }
    EXPECT_EQ(picture.at(0, 0)[0], 0);
    EXPECT_EQ(picture.at(100, 0)[1], 253);
}

}  // namespace
}  // namespace penumbra
