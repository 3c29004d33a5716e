// SPDX-License-Identifier: MIT
// Pictures compared, turned and summed.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>
#include <utility>

#include "core/image/image.h"

namespace penumbra::test {

struct Difference {
    double max = 0;
    double mean = 0;  // over all samples
    double share_above = 0;
};

// Absolute differences; `share_above` is the share of samples that differ by more than `bound`. Pictures of
// unlike size differ by infinity.
Difference difference(const ImageF& a, const ImageF& b, double bound = 0);
Difference difference(const Image8& a, const Image8& b);

double mean(const ImageF& image);
glm::dvec3 mean_colour(const ImageF& image);
double largest(const ImageF& image);
bool all_finite(const ImageF& image);

// The linear value of an sRGB code (IEC 61966-2-1).
double srgb_decode(int code);
int srgb_encode(double linear);

// out(x, y) = in(from(x, y)).
template <class T>
BasicImage<T> rearrange(const BasicImage<T>& in, int width, int height,
                        const std::function<std::pair<int, int>(int, int)>& from) {
    BasicImage<T> out(width, height, in.channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto [sx, sy] = from(x, y);
            for (int c = 0; c < in.channels; ++c) out.at(x, y)[c] = in.at(sx, sy)[c];
        }
    return out;
}

template <class T>
BasicImage<T> mirrored(const BasicImage<T>& in) {
    return rearrange<T>(in, in.width, in.height, [&](int x, int y) { return std::pair(in.width - 1 - x, y); });
}

template <class T>
BasicImage<T> flipped(const BasicImage<T>& in) {
    return rearrange<T>(in, in.width, in.height, [&](int x, int y) { return std::pair(x, in.height - 1 - y); });
}

// By 90 degrees clockwise on screen.
template <class T>
BasicImage<T> turned(const BasicImage<T>& in) {
    return rearrange<T>(in, in.height, in.width, [&](int x, int y) { return std::pair(y, in.height - 1 - x); });
}

template <class T>
BasicImage<T> crop(const BasicImage<T>& in, int x0, int y0, int width, int height) {
    return rearrange<T>(in, width, height, [&](int x, int y) { return std::pair(x + x0, y + y0); });
}

}  // namespace penumbra::test
