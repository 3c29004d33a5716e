// SPDX-License-Identifier: MIT
// What may be said of any picture of a scene, and of a picture beside the truth.
#pragma once

#include <string>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace penumbra::test {

// The exact solver's picture; solid pixels are NaN.
ImageF truth_of(const Scene& scene, int stride = 1);

// The largest radiance of any source in each channel.
Colour brightest_source(const Scene& scene);

// What no picture may hold: what is no number, infinite, negative (zero included), or brighter than the brightest source by
// more than single precision's roundings. Empty when it holds none.
std::string impossible(const Scene& scene, const ImageF& picture);

// Error figures, 0 where they have no meaning.
struct Off {
    double rel = 0, max = 0, bias = 0, leak = 0, nrmse = 0;
    double of_peak = 0;      // mean |a - b|, over the brightest source's
    double max_of_peak = 0;  // largest |a - b|, over the brightest source's
};
Off off_by(const Scene& scene, const ImageF& picture, const ImageF& truth);

// Two pictures that should be one: mean |a - b| / (b + 0.05 mean b) and largest |a - b| over the mean of b. NaN in either
// is left out.
struct Apart {
    double rel = 0, max = 0;
};
Apart apart(const ImageF& a, const ImageF& b);

}  // namespace penumbra::test
