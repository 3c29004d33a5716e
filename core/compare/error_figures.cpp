// SPDX-License-Identifier: MIT
#include "core/compare/error_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace penumbra {

namespace {

template <class T>
std::optional<Problem> size_problem(const BasicImage<T>& a, const BasicImage<T>& b) {
    const auto describe = [](const BasicImage<T>& i) {
        return std::to_string(i.width) + " x " + std::to_string(i.height);
    };
    if (a.width == b.width && a.height == b.height) return std::nullopt;
    return Problem{"", "size_differs",
                   "The pictures differ in size: " + describe(a) + " against " + describe(b) + "."};
}

// Between ranks, linear. Reorders the values.
double percentile(std::vector<double>& values, double share) {
    const double rank = share * double(values.size() - 1);
    const auto low = std::size_t(rank);
    const auto at = values.begin() + std::ptrdiff_t(low);
    std::nth_element(values.begin(), at, values.end());
    const double below = *at;
    if (low + 1 >= values.size()) return below;
    const double above = *std::min_element(at + 1, values.end());
    return below + (above - below) * (rank - double(low));
}

template <class T>
std::array<int, 4> rgba_at(const BasicImage<T>& image, std::size_t pixel) {
    constexpr int kOpaque = std::numeric_limits<T>::max();
    const T* p = image.data.data() + pixel * std::size_t(image.channels);
    switch (image.channels) {
        case 1:
            return {p[0], p[0], p[0], kOpaque};
        case 2:
            return {p[0], p[0], p[0], p[1]};
        case 3:
            return {p[0], p[1], p[2], kOpaque};
        default:
            return {p[0], p[1], p[2], p[3]};
    }
}

}  // namespace

std::variant<ErrorFigures, Problem> error_figures(const ImageF& a, const ImageF& b) {
    if (auto problem = size_problem(a, b)) return *problem;
    const int channels = std::min(a.channels, 3);
    if (channels != std::min(b.channels, 3) || channels == 0) {
        return Problem{"", "channels_differ",
                       "The pictures differ in their channels: " + std::to_string(a.channels) +
                           " against " + std::to_string(b.channels) + "."};
    }
    ErrorFigures figures;
    std::vector<std::array<double, 2>> samples;
    const std::size_t pixels = std::size_t(a.width) * std::size_t(a.height);
    samples.reserve(pixels * std::size_t(channels));
    double sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        for (int c = 0; c < channels; ++c) {
            const double x = a.data[i * std::size_t(a.channels) + std::size_t(c)];
            const double y = b.data[i * std::size_t(b.channels) + std::size_t(c)];
            if (!std::isfinite(y)) continue;
            if (!std::isfinite(x)) {
                ++figures.nan_only_a;
                continue;
            }
            samples.push_back({x, y});
            sum_a += x;
            sum_b += y;
        }
    }
    figures.count = samples.size();
    if (samples.empty()) return figures;

    const double count = double(samples.size());
    const double mean = sum_b / count;
    figures.mean_truth = mean;
    std::vector<double> differences;
    differences.reserve(samples.size());
    double squares = 0, largest = 0, relative = 0, in_dark = 0;
    std::uint64_t dark = 0;
    for (const auto& [x, y] : samples) {
        const double difference = std::abs(x - y);
        differences.push_back(difference);
        squares += difference * difference;
        largest = std::max(largest, difference);
        relative += difference / (y + 0.05 * mean);
        if (y < 1e-6 * mean) {
            in_dark += x;
            ++dark;
        }
    }
    figures.rmse = std::sqrt(squares / count);
    figures.max_abs = largest;
    if (mean == 0) return figures;
    figures.nrmse = *figures.rmse / mean;
    figures.rel = relative / count;
    figures.p99 = percentile(differences, 0.99) / mean;
    figures.max = largest / mean;
    figures.bias = (sum_a - sum_b) / count / mean;
    if (dark > 0) figures.leak = in_dark / double(dark) / mean;
    return figures;
}

namespace {

template <class T>
std::variant<PixelFigures, Problem> figures_of(const BasicImage<T>& a, const BasicImage<T>& b) {
    constexpr double kCode = sizeof(T) == 2 ? 257.0 : 1.0;
    if (auto problem = size_problem(a, b)) return *problem;
    PixelFigures figures;
    figures.pixels = std::uint64_t(a.width) * std::uint64_t(a.height);
    // A channel that neither has does not dilute the means.
    const bool coloured = std::max(a.channels, b.channels) >= 3;
    const bool alpha = a.channels % 2 == 0 || b.channels % 2 == 0;
    std::vector<std::size_t> compared{0};
    if (coloured) compared = {0, 1, 2};
    if (alpha) compared.push_back(3);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < figures.pixels; ++i) {
        const auto x = rgba_at(a, i), y = rgba_at(b, i);
        bool differs = false;
        for (const std::size_t c : compared) {
            const double difference = std::abs(x[c] - y[c]) / kCode;
            figures.largest = std::max(figures.largest, difference);
            sum += difference;
            squares += difference * difference;
            differs = differs || difference != 0;
        }
        figures.differing += differs ? 1 : 0;
    }
    const double count = double(figures.pixels) * double(compared.size());
    if (count == 0) return figures;
    figures.mean = sum / count;
    if (squares > 0) figures.psnr_db = 10 * std::log10(255.0 * 255.0 * count / squares);
    return figures;
}

}  // namespace

std::variant<PixelFigures, Problem> pixel_figures(const Image8& a, const Image8& b) { return figures_of(a, b); }
std::variant<PixelFigures, Problem> pixel_figures(const Image16& a, const Image16& b) { return figures_of(a, b); }

}  // namespace penumbra
