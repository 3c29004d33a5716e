// SPDX-License-Identifier: MIT
#include "core/plan/shape_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "glsl/scene_records.h"

namespace penumbra {
namespace {

using glm::dvec2;
using glm::vec4;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// The shader's float arithmetic loses less than this share of the coordinates it starts from: some ten operations of
// 6e-8 each. It costs nothing to be generous: lists grow by shapes that are farther by as much.
constexpr double kRounding = 1e-5;
constexpr double kLeastRounding = 1e-4;
// The ellipse's root loses more digits, most on its evolute (tests/gpu/distance_gltest.cpp: 5e-4 of its length).
constexpr double kEllipseRounding = 2e-3;
// Thinner needles are not judged: the shader squares the ratio of the axes.
constexpr double kThinnestEllipse = 1e-3;

dvec2 rotate_into(dvec2 p, dvec2 cos_sin) {
    return {cos_sin.x * p.x + cos_sin.y * p.y, cos_sin.x * p.y - cos_sin.y * p.x};
}

double largest(vec4 v) {
    return std::max({std::abs(double(v.x)), std::abs(double(v.y)), std::abs(double(v.z)), std::abs(double(v.w))});
}

double segment_distance(dvec2 p, vec4 edge) {
    const dvec2 from(edge.x, edge.y);
    const dvec2 along = dvec2(edge.z, edge.w) - from;
    const double squared = glm::dot(along, along);
    const double h = squared > 0 ? std::clamp(glm::dot(p - from, along) / squared, 0.0, 1.0) : 0.0;
    return glm::length(p - from - along * h);
}

// As the shader finds it (glsl/lib/scene.glsl): the root of Eberly's equation by Newton's method.
double ellipse_distance(dvec2 p, dvec2 r) {
    p = glm::abs(p);
    if (r.x < r.y) {
        std::swap(p.x, p.y);
        std::swap(r.x, r.y);
    }
    const dvec2 z = p / r;
    const double ratio = (r.x / r.y) * (r.x / r.y);
    const double focus = (r.x - r.y) * (r.x + r.y);
    if (z.y < 1e-12 && p.x * r.x < focus) {
        const double x = p.x * r.x / focus;
        return -glm::length(dvec2(r.x * x, r.y * std::sqrt(std::max(1.0 - x * x, 0.0))) - p);
    }
    double t = std::max(z.y - 1.0, ratio * (z.x - 1.0));
    for (int i = 0; i < 30; ++i) {
        const dvec2 d(t + ratio, t + 1.0);
        const dvec2 a = dvec2(ratio * z.x, z.y) / glm::max(d, dvec2(1e-100));
        const double slope = -2.0 * (a.x * a.x / std::max(d.x, 1e-100) + a.y * a.y / std::max(d.y, 1e-100));
        const double next = t - (glm::dot(a, a) - 1.0) / std::min(slope, -1e-100);
        if (!(next > t)) break;
        t = next;
    }
    const double distance = glm::length(dvec2(ratio * p.x / (t + ratio), p.y / std::max(t + 1.0, 1e-100)) - p);
    return glm::dot(z, z) < 1.0 ? -distance : distance;
}

// Inside or outside by the even-odd rule.
bool is_inside(const PackedScene& scene, std::size_t first, std::size_t end, dvec2 p) {
    bool odd = false;
    for (std::size_t i = first; i < end; ++i) {
        const vec4& e = scene.edges[i];
        if ((e.y > p.y) != (e.w > p.y) &&
            p.x < e.x + (p.y - e.y) * (double(e.z) - e.x) / (double(e.w) - e.y)) odd = !odd;
    }
    return odd;
}

}  // namespace

DistanceBounds distance_bounds(const PackedScene& scene, std::size_t index, dvec2 p, double reach, double enough) {
    const vec4* record = &scene.shapes[index * glsl::kShapeTexels];
    const vec4 a = record[2];
    const vec4 b = record[3];
    const int type = static_cast<int>(record[0].x);
    const double coordinates = std::max({largest(a), std::abs(p.x) + reach, std::abs(p.y) + reach, double(b.z)});
    const double slack = reach + kLeastRounding + kRounding * coordinates;
    const auto about = [&](double d) { return DistanceBounds{d - slack, d + slack}; };
    // The box of a polyline, polygon or bitmap.
    const auto box_distance = [&](dvec2 lo, dvec2 hi) { return glm::length(glm::max(glm::max(lo - p, p - hi), dvec2(0))); };
    switch (type) {
        case glsl::kShapeCircle: return about(glm::length(p - dvec2(a.x, a.y)) - double(a.z));
        case glsl::kShapeRect: {
            const double corner = b.z;
            const dvec2 q = glm::abs(rotate_into(p - dvec2(a.x, a.y), {b.x, b.y})) - dvec2(a.z, a.w) + corner;
            return about(glm::length(glm::max(q, dvec2(0))) + std::min(std::max(q.x, q.y), 0.0) - corner);
        }
        case glsl::kShapeLine: return about(segment_distance(p, a) - double(b.z));
        case glsl::kShapeEllipse: {
            const dvec2 r(a.z, a.w);
            const double longer = std::max(r.x, r.y);
            if (!(std::min(r.x, r.y) >= kThinnestEllipse * longer)) return {-kUnknown, kUnknown};
            const dvec2 q = rotate_into(p - dvec2(a.x, a.y), {b.x, b.y});
            const double d = ellipse_distance(q, r);
            const double more = slack + kEllipseRounding * (longer + glm::length(q));
            return {d - more, d + more};
        }
        case glsl::kShapeBitmap: {
            // The shader says "solid" or "far": the distance itself comes from jump flooding.
            const double d = box_distance({a.x, a.y}, {double(a.x) + a.z, double(a.y) + a.w});
            return {d > slack ? kUnknown : -1.0, kUnknown};
        }
        default: break;
    }
    const double half = b.z;
    const double box = box_distance({a.x, a.y}, {a.z, a.w}) - half;
    if (box - slack > enough) return {box - slack, kUnknown};
    const auto first = static_cast<std::size_t>(record[0].z);
    const std::size_t end = first + static_cast<std::size_t>(record[0].w);
    double nearest = kUnknown;
    for (std::size_t i = first; i < end; ++i) nearest = std::min(nearest, segment_distance(p, scene.edges[i]));
    if (type == glsl::kShapePolyline) return about(nearest - half);
    // Where an outline passes through, the sign is not known.
    if (nearest <= slack) return {-nearest - slack, nearest + slack};
    return about(is_inside(scene, first, end, p) ? -nearest : nearest);
}

}  // namespace penumbra
