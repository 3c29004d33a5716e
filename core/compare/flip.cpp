// SPDX-License-Identifier: MIT
// Section, equation and table numbers are those of the paper named in flip.h.
#include "core/compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace penumbra {

namespace {

using Vec3 = glm::dvec3;

constexpr double kPi = std::numbers::pi;

// Section 4.1: exponents and the remapping of the colour difference; 4.2: width and exponent of
// features.
constexpr double kColourExponent = 0.7;     // q_c
constexpr double kRemapKnee = 0.4;          // p_c
constexpr double kRemapValue = 0.95;        // p_t
constexpr double kFeatureExponent = 0.5;    // q_f
constexpr double kFeatureWidthDeg = 0.082;  // w

// Contrast sensitivity as sums of Gaussians  a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees (table
// 1).
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1e-5};
constexpr Sensitivity kRedGreen{1, 0.0053, 0, 1e-5};
constexpr Sensitivity kBlueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double kWidestSensitivity = 0.04;

// Linear sRGB to CIE XYZ (D65), columns by primary.
const glm::dmat3& rgb_to_xyz() {
    static const glm::dmat3 matrix(10135552.0 / 24577794, 2613072.0 / 12288897,
                                   1425312.0 / 73733382, 8788810.0 / 24577794, 8788810.0 / 12288897,
                                   8788810.0 / 73733382, 4435075.0 / 24577794, 887015.0 / 12288897,
                                   70074185.0 / 73733382);
    return matrix;
}
const glm::dmat3& xyz_to_rgb() {
    static const glm::dmat3 matrix = glm::inverse(rgb_to_xyz());
    return matrix;
}
const Vec3& white() {
    static const Vec3 xyz = rgb_to_xyz() * Vec3(1);
    return xyz;
}

double decoded(std::uint8_t value) {
    const double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// The opponent space in which linear filters act: luminance, red-green, blue-yellow (eq. 2 on).
Vec3 xyz_to_ycxcz(const Vec3& xyz) {
    const Vec3 r = xyz / white();
    return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

Vec3 ycxcz_to_xyz(const Vec3& c) {
    const double y = (c.x + 16) / 116;
    return Vec3(y + c.y / 500, y, y - c.z / 200) * white();
}

double lab_curve(double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

// L*a*b* with the Hunt effect: colours look less colourful in the dark (section 4.1.3).
Vec3 rgb_to_hunt_lab(const Vec3& rgb) {
    const Vec3 r = rgb_to_xyz() * rgb / white();
    const double fx = lab_curve(r.x), fy = lab_curve(r.y), fz = lab_curve(r.z);
    const double lightness = 116 * fy - 16;
    return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

// HyAB: city block in lightness, Euclidean in the chromatic plane; made for large differences.
double hyab(const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

struct Plane {
    int width, height;
    std::vector<double> data;

    Plane(int w, int h) : width(w), height(h), data(std::size_t(w) * std::size_t(h)) {}
};

struct Kernel {
    int radius;
    std::vector<double> weight;  // 2 radius + 1

    explicit Kernel(int r) : radius(r), weight(std::size_t(2 * r + 1)) {}
    double& at(int x) { return weight[std::size_t(x + radius)]; }
    double sum() const {
        double total = 0;
        for (const double w : weight) total += w;
        return total;
    }
};

// Along rows, then along columns; the border's pixels go on beyond it.
Plane filtered(const Plane& in, const Kernel& across, const Kernel& down) {
    Plane half(in.width, in.height), out(in.width, in.height);
    for (int y = 0; y < in.height; ++y) {
        const double* row = in.data.data() + std::size_t(y) * std::size_t(in.width);
        double* to = half.data.data() + std::size_t(y) * std::size_t(in.width);
        for (int x = 0; x < in.width; ++x) {
            double sum = 0;
            for (int k = -across.radius; k <= across.radius; ++k) {
                sum += across.weight[std::size_t(k + across.radius)] *
                       row[std::clamp(x + k, 0, in.width - 1)];
            }
            to[x] = sum;
        }
    }
    for (int y = 0; y < in.height; ++y) {
        double* to = out.data.data() + std::size_t(y) * std::size_t(in.width);
        for (int k = -down.radius; k <= down.radius; ++k) {
            const double weight = down.weight[std::size_t(k + down.radius)];
            const int from = std::clamp(y + k, 0, in.height - 1);
            const double* row = half.data.data() + std::size_t(from) * std::size_t(in.width);
            for (int x = 0; x < in.width; ++x) to[x] += weight * row[x];
        }
    }
    return out;
}

// A round sum of Gaussians is a sum of two separable filters; the whole is normalised to 1.
Plane contrast_filtered(const Plane& in, const Sensitivity& s, double pixels_per_degree) {
    const int radius =
        int(std::ceil(3 * std::sqrt(kWidestSensitivity / (2 * kPi * kPi)) * pixels_per_degree));
    Plane out(in.width, in.height);
    const auto gaussian = [&](double b) {
        Kernel kernel(radius);
        for (int x = -radius; x <= radius; ++x) {
            const double degrees = x / pixels_per_degree;
            kernel.at(x) = std::exp(-kPi * kPi * degrees * degrees / b);
        }
        return kernel;
    };
    const Kernel first = gaussian(s.b1), second = gaussian(s.b2);
    const double scale_first = s.a1 * std::sqrt(kPi / s.b1),
                 scale_second = s.a2 * std::sqrt(kPi / s.b2);
    const double total =
        scale_first * first.sum() * first.sum() + scale_second * second.sum() * second.sum();
    const auto add = [&](const Kernel& kernel, double scale) {
        if (scale == 0) return;
        const Plane part = filtered(in, kernel, kernel);
        for (std::size_t i = 0; i < out.data.size(); ++i)
            out.data[i] += scale / total * part.data[i];
    };
    add(first, scale_first);
    add(second, scale_second);
    return out;
}

struct Features {
    std::vector<double> edges, points;
};

// Section 4.2: derivatives of a Gaussian, scaled so that their positive and negative weights sum to
// 1 and -1; lengths of the gradient (edges) and of the second derivatives (points, lines).
Features features_of(const Plane& luminance, double pixels_per_degree) {
    const double deviation = 0.5 * kFeatureWidthDeg * pixels_per_degree;
    const int radius = int(std::ceil(3 * deviation));
    Kernel smooth(radius), edge(radius), point(radius);
    for (int x = -radius; x <= radius; ++x) {
        const double g = std::exp(-0.5 * x * x / (deviation * deviation));
        smooth.at(x) = g;
        edge.at(x) = -x * g;
        point.at(x) = (x * x / (deviation * deviation) - 1) * g;
    }
    const double total = smooth.sum();
    for (double& w : smooth.weight) w /= total;
    for (Kernel* kernel : {&edge, &point}) {
        double up = 0, down = 0;
        for (const double w : kernel->weight) (w > 0 ? up : down) += std::abs(w);
        for (double& w : kernel->weight) {
            const double side = w > 0 ? up : down;
            if (side > 0) w /= side;
        }
    }
    Features out;
    const auto lengths = [&](const Kernel& kernel) {
        const Plane x = filtered(luminance, kernel, smooth);
        const Plane y = filtered(luminance, smooth, kernel);
        std::vector<double> length(x.data.size());
        for (std::size_t i = 0; i < length.size(); ++i)
            length[i] = std::hypot(x.data[i], y.data[i]);
        return length;
    };
    out.edges = lengths(edge);
    out.points = lengths(point);
    return out;
}

// What the eye keeps of a picture.
struct Percept {
    std::vector<Vec3> colour;  // Hunt-adjusted L*a*b* after filtering
    Features features;
};

Percept percept_of(const Image8& image, double pixels_per_degree) {
    std::array<double, 256> table{};
    for (int i = 0; i < 256; ++i) table[std::size_t(i)] = decoded(std::uint8_t(i));
    Plane y(image.width, image.height), cx(image.width, image.height),
        cz(image.width, image.height);
    Plane luminance(image.width, image.height);
    const std::size_t count = y.data.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* p = image.data.data() + i * std::size_t(image.channels);
        const bool grey = image.channels < 3;
        const Vec3 rgb(table[p[0]], table[grey ? p[0] : p[1]], table[grey ? p[0] : p[2]]);
        const Vec3 opponent = xyz_to_ycxcz(rgb_to_xyz() * rgb);
        y.data[i] = opponent.x;
        cx.data[i] = opponent.y;
        cz.data[i] = opponent.z;
        luminance.data[i] = (opponent.x + 16) / 116;  // features see it in [0, 1]
    }
    Percept made;
    made.features = features_of(luminance, pixels_per_degree);
    y = contrast_filtered(y, kAchromatic, pixels_per_degree);
    cx = contrast_filtered(cx, kRedGreen, pixels_per_degree);
    cz = contrast_filtered(cz, kBlueYellow, pixels_per_degree);
    made.colour.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 rgb = xyz_to_rgb() * ycxcz_to_xyz({y.data[i], cx.data[i], cz.data[i]});
        made.colour[i] = rgb_to_hunt_lab(glm::clamp(rgb, 0.0, 1.0));
    }
    return made;
}

// Section 4.1.4: the low 40 % of the largest difference (green against blue) spread over 95 % of
// the range.
double remapped(double difference, double largest) {
    const double knee = kRemapKnee * largest;
    if (difference < knee) return kRemapValue / knee * difference;
    return kRemapValue + (difference - knee) / (largest - knee) * (1 - kRemapValue);
}

}  // namespace

std::variant<Flip, Problem> flip(const Image8& a, const Image8& b, const FlipOptions& options) {
    if (a.width != b.width || a.height != b.height) {
        return Problem{"", "size_differs",
                       "The pictures differ in size: " + std::to_string(a.width) + " x " +
                           std::to_string(a.height) + " against " + std::to_string(b.width) +
                           " x " + std::to_string(b.height) + "."};
    }
    const Percept first = percept_of(a, options.pixels_per_degree);
    const Percept second = percept_of(b, options.pixels_per_degree);
    const double largest =
        std::pow(hyab(rgb_to_hunt_lab({0, 1, 0}), rgb_to_hunt_lab({0, 0, 1})), kColourExponent);
    Flip result;
    result.map = ImageF(a.width, a.height, 1);
    double sum = 0;
    for (std::size_t i = 0; i < first.colour.size(); ++i) {
        const double colour =
            remapped(std::pow(hyab(first.colour[i], second.colour[i]), kColourExponent), largest);
        const double edge = std::abs(first.features.edges[i] - second.features.edges[i]);
        const double point = std::abs(first.features.points[i] - second.features.points[i]);
        const double feature =
            std::pow(std::max(edge, point) / std::numbers::sqrt2, kFeatureExponent);
        // Features amplify what colour shows (section 4.3).
        const double value = std::clamp(std::pow(colour, 1 - std::min(feature, 1.0)), 0.0, 1.0);
        result.map.data[i] = float(value);
        sum += value;
    }
    if (!first.colour.empty()) result.mean = sum / double(first.colour.size());
    return result;
}

}  // namespace penumbra
