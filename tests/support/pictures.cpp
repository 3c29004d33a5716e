// SPDX-License-Identifier: MIT
#include "tests/support/pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::test {
namespace {

template <class T>
Difference compare(const BasicImage<T>& a, const BasicImage<T>& b, double bound) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (a.width != b.width || a.height != b.height || a.channels != b.channels || a.data.empty())
        return {kInfinite, kInfinite, 1};
    Difference result;
    for (std::size_t i = 0; i < a.data.size(); ++i) {
        const double d = std::abs(double(a.data[i]) - double(b.data[i]));
        if (!(d <= std::numeric_limits<double>::max())) return {kInfinite, kInfinite, 1};
        result.max = std::max(result.max, d);
        result.mean += d;
        if (d > bound) result.share_above += 1;
    }
    const auto count = double(a.data.size());
    result.mean /= count;
    result.share_above /= count;
    return result;
}

}  // namespace

Difference difference(const ImageF& a, const ImageF& b, double bound) { return compare(a, b, bound); }
Difference difference(const Image8& a, const Image8& b) { return compare(a, b, 0); }

double mean(const ImageF& image) {
    double sum = 0;
    for (const float v : image.data) sum += v;
    return sum / double(image.data.size());
}

glm::dvec3 mean_colour(const ImageF& image) {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i + 2 < image.data.size(); i += 3)
        sum += glm::dvec3(image.data[i], image.data[i + 1], image.data[i + 2]);
    return sum / (double(image.data.size()) / 3);
}

double largest(const ImageF& image) {
    return *std::max_element(image.data.begin(), image.data.end());
}

bool all_finite(const ImageF& image) {
    return std::all_of(image.data.begin(), image.data.end(), [](float v) { return std::isfinite(v) && v >= 0; });
}

double srgb_decode(int code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

int srgb_encode(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    const double c = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<int>(std::floor(255 * c + 0.5));
}

}  // namespace penumbra::test
