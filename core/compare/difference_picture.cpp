// SPDX-License-Identifier: MIT
#include "core/compare/difference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/compare/error_figures.h"

namespace penumbra {

namespace {

using Stop = std::array<int, 3>;

// The colour map "magma" (S. van der Walt and N. Smith, 2015, CC0) at ten steps.
constexpr std::array<Stop, 10> kHeat{{{0, 0, 4},
                                      {24, 15, 61},
                                      {68, 15, 118},
                                      {114, 31, 129},
                                      {158, 47, 127},
                                      {205, 64, 113},
                                      {241, 96, 93},
                                      {253, 150, 104},
                                      {254, 202, 141},
                                      {252, 253, 191}}};
// From a strong blue over white to a strong red, even in lightness to both sides.
constexpr std::array<Stop, 7> kSigned{{{5, 48, 97},
                                       {67, 147, 195},
                                       {180, 214, 235},
                                       {255, 255, 255},
                                       {248, 195, 172},
                                       {214, 96, 77},
                                       {103, 0, 31}}};
constexpr std::array<std::uint8_t, 3> kNothing{128, 128, 128};
constexpr std::array<std::uint8_t, 3> kMissing{0, 160, 60};

constexpr double kDecades = 3;  // of relative difference, up to 1

template <std::size_t N>
std::array<std::uint8_t, 3> colour_at(const std::array<Stop, N>& stops, double share) {
    const double place = std::clamp(share, 0.0, 1.0) * double(N - 1);
    const auto low = std::min(std::size_t(place), N - 2);
    std::array<std::uint8_t, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double value =
            stops[low][c] + (stops[low + 1][c] - stops[low][c]) * (place - double(low));
        out[c] = std::uint8_t(std::lround(value));
    }
    return out;
}

}  // namespace

Image8 heat_picture(const ImageF& map) {
    Image8 out(map.width, map.height, 3);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const float value = *map.at(x, y);
            const auto colour = std::isfinite(value) ? colour_at(kHeat, value) : kNothing;
            std::copy(colour.begin(), colour.end(), out.at(x, y));
        }
    }
    return out;
}

std::variant<Image8, Problem> signed_picture(const ImageF& a, const ImageF& b) {
    const auto compared = error_figures(a, b);
    if (const auto* problem = std::get_if<Problem>(&compared)) return *problem;
    const auto& figures = std::get<ErrorFigures>(compared);
    // Against a black truth only the picture's own size is left to measure by.
    const double mean = figures.mean_truth.value_or(0);
    const double floor = mean > 0 ? 0.05 * mean : figures.max_abs.value_or(0);
    const int channels = std::min(a.channels, 3);
    Image8 out(a.width, a.height, 3);
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const float* p = a.at(x, y);
            const float* q = b.at(x, y);
            double sum = 0;
            bool nothing = false, missing = false;
            for (int c = 0; c < channels; ++c) {
                nothing = nothing || !std::isfinite(q[c]);
                missing = missing || !std::isfinite(p[c]);
                const double scale = q[c] + floor;
                if (scale > 0) sum += (double(p[c]) - q[c]) / scale;
            }
            const double relative = sum / channels;
            double strength = 0;
            if (relative != 0)
                strength = std::clamp(1 + std::log10(std::abs(relative)) / kDecades, 0.0, 1.0);
            const double share = 0.5 + (relative > 0 ? 0.5 : -0.5) * strength;
            const auto colour = nothing ? kNothing : missing ? kMissing : colour_at(kSigned, share);
            std::copy(colour.begin(), colour.end(), out.at(x, y));
        }
    }
    return out;
}

}  // namespace penumbra
