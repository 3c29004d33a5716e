// SPDX-License-Identifier: MIT
// How far a picture is from the truth: the error figures of docs/light-transport.md for linear
// pictures, and plain differences for 8-bit ones.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "core/image/image.h"
#include "core/scene/problem.h"

namespace penumbra {

// Each channel (of the first three) of each pixel is a sample. A sample that is NaN in the truth is
// left out everywhere. A figure that has no meaning (no samples, or relative to a truth that is
// black all over) is empty.
struct ErrorFigures {
    std::optional<double> nrmse;  // sqrt(mean (a - b)^2) / mean b
    std::optional<double> rel;    // mean |a - b| / (b + 0.05 mean b)
    std::optional<double> p99;    // 99th percentile of |a - b|, over mean b
    std::optional<double> max;    // largest |a - b|, over mean b
    std::optional<double> bias;   // (mean a - mean b) / mean b
    std::optional<double>
        leak;  // mean of a where b < 1e-6 mean b, over mean b; empty where b is nowhere so dark
    std::optional<double> rmse;
    std::optional<double> max_abs;
    std::optional<double> mean_truth;
    std::uint64_t count = 0;       // samples compared
    std::uint64_t nan_only_a = 0;  // samples that the picture lacks (not finite) and the truth has
};

// `a` is the picture, `b` the truth. A problem when their sizes or channels do not agree.
std::variant<ErrorFigures, Problem> error_figures(const ImageF& a, const ImageF& b);

struct PixelFigures {
    double largest = 0;           // difference of a channel, 0 to 255; of 16 bits with a fraction
    double mean = 0;              // difference of a channel, over all channels and pixels
    std::uint64_t differing = 0;  // pixels with a difference in any channel
    std::uint64_t pixels = 0;
    std::optional<double> psnr_db;  // empty for equal pictures
};

// Compares as encoded. Grey is taken as equal RGB, a missing alpha as 255.
std::variant<PixelFigures, Problem> pixel_figures(const Image8& a, const Image8& b);
// In the same units: a code of 8 bits is 257 of 16.
std::variant<PixelFigures, Problem> pixel_figures(const Image16& a, const Image16& b);

}  // namespace penumbra
