// SPDX-License-Identifier: MIT
#include "core/film/exposure.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr double kSaturation = 78.0 / (100.0 * 0.65);
constexpr double kDarkest = 1.0 / 1024;  // of the mean: ten stops below it
constexpr double kMostEv = 64;           // either way: with any radiance, the product stays finite in single precision

}  // namespace

double ev100_of(const Camera& camera) {
    return std::log2(camera.aperture * camera.aperture / camera.shutter_s * 100.0 / camera.iso);
}

double exposure_of_ev100(double ev100) { return 1.0 / (kSaturation * std::exp2(ev100)); }

double luminance(const Colour& linear) { return 0.2126 * linear.r + 0.7152 * linear.g + 0.0722 * linear.b; }

void LogAverage::add_to_mean(double luminance) {
    sum_ += luminance;
    ++count_;
}

void LogAverage::add(double luminance) {
    if (!(luminance > 0) || luminance * double(count_) < kDarkest * sum_) return;
    logs_ += std::log(luminance);
    ++counted_;
}

std::optional<double> LogAverage::value() const {
    if (counted_ == 0) return std::nullopt;
    return std::exp(logs_ / double(counted_));
}

double exposure_factor(const OutputSettings& output, std::optional<double> log_average) {
    double factor = std::exp2(output.exposure_ev);
    if (output.camera) factor *= exposure_of_ev100(ev100_of(*output.camera));
    if (output.auto_key) factor = log_average ? *output.auto_key / *log_average : 1.0;
    return std::clamp(factor, std::exp2(-kMostEv), std::exp2(kMostEv));
}

}  // namespace penumbra
