// SPDX-License-Identifier: MIT
// What radiance is multiplied with before the tone curve (docs/film.md).
#pragma once

#include <cstddef>
#include <optional>

#include "core/scene/scene.h"

namespace penumbra {

// Exposure value at ISO 100 of a camera's settings: log2(N^2 / t * 100 / S).
double ev100_of(const Camera& camera);

// What a camera of this EV100 multiplies luminance with: 1 / (1.2 * 2^EV100). Saturation-based speed (ISO 12232:2006): 78 / (100 q)
// with q = 0.65, the light that a usual lens lets through, is 1.2.
double exposure_of_ev100(double ev100);

double luminance(const Colour& linear);  // Rec. 709

// The log-average luminance of the samples that it is given, one after the other: exp(mean of ln Y) (Reinhard et al.,
// "Photographic Tone Reproduction for Digital Images", 2002, equation 1). Instead of their small delta, which makes the result depend on
// the scene's unit, samples darker than 1/1024 of the mean are left out: where no light comes, none is exposed for.
class LogAverage {
public:
    // Asked twice: all samples for the mean, then all again.
    void add_to_mean(double luminance);
    void add(double luminance);
    std::optional<double> value() const;  // empty where all is black

private:
    double sum_ = 0;
    double logs_ = 0;
    std::size_t count_ = 0;
    std::size_t counted_ = 0;
};

// The factor of the scene's settings; `log_average` is asked for with automatic exposure only, and 1 without any light.
double exposure_factor(const OutputSettings& output, std::optional<double> log_average = std::nullopt);

}  // namespace penumbra
