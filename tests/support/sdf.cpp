// SPDX-License-Identifier: MIT
#include "tests/support/sdf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace penumbra::test {
namespace {

using glm::dvec2;

dvec2 unrotated(dvec2 p, double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return {std::cos(a) * p.x + std::sin(a) * p.y, std::cos(a) * p.y - std::sin(a) * p.x};
}

double to_segment(dvec2 p, dvec2 a, dvec2 b) {
    const dvec2 along = b - a;
    const double squared = glm::dot(along, along);
    const double h = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
    return glm::length(p - a - along * h);
}

double distance(const Circle& g, dvec2 p) { return glm::length(p - g.center) - g.radius; }

// Eberly, "Distance from a Point to an Ellipse", by bisection: slow, and never wrong.
double distance(const Ellipse& g, dvec2 p) {
    dvec2 y = glm::abs(unrotated(p - g.center, g.rotation_deg));
    dvec2 e = g.radii;
    if (e.x < e.y) {
        std::swap(e.x, e.y);
        std::swap(y.x, y.y);
    }
    const dvec2 z = y / e;
    const double inside = glm::dot(z, z) - 1;
    dvec2 nearest;
    if (y.y > 0) {
        const double ratio = (e.x / e.y) * (e.x / e.y);
        double lo = z.y - 1;
        double hi = inside < 0 ? 0 : std::hypot(ratio * z.x, z.y) - 1;
        for (int i = 0; i < 2000; ++i) {
            const double s = 0.5 * (lo + hi);
            if (s == lo || s == hi) break;
            const dvec2 r(ratio * z.x / (s + ratio), z.y / (s + 1));
            (glm::dot(r, r) > 1 ? lo : hi) = s;
        }
        const double s = 0.5 * (lo + hi);
        nearest = {ratio * y.x / (s + ratio), y.y / (s + 1)};
    } else if (const double reach = (e.x * e.x - e.y * e.y) / e.x; y.x < reach) {
        const double x = y.x / reach;
        nearest = {e.x * x, e.y * std::sqrt(1 - x * x)};
    } else {
        nearest = {e.x, 0};
    }
    return std::copysign(glm::length(nearest - y), inside);
}

double distance(const Rect& g, dvec2 p) {
    const dvec2 half = 0.5 * g.size - g.corner_radius;
    const dvec2 q = glm::abs(unrotated(p - g.center, g.rotation_deg)) - half;
    return std::hypot(std::max(q.x, 0.0), std::max(q.y, 0.0)) + std::min(std::max(q.x, q.y), 0.0) - g.corner_radius;
}

double distance(const Line& g, dvec2 p) { return to_segment(p, g.from, g.to) - 0.5 * g.width; }

double to_outline(const std::vector<Point>& points, bool closed, dvec2 p) {
    double nearest = glm::length(p - points[0]);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) nearest = std::min(nearest, to_segment(p, points[i], points[i + 1]));
    if (closed) nearest = std::min(nearest, to_segment(p, points.back(), points.front()));
    return nearest;
}

double distance(const Polyline& g, dvec2 p) { return to_outline(g.points, g.closed, p) - 0.5 * g.width; }

double distance(const Polygon& g, dvec2 p) {
    // Even-odd by the parity of crossings above the point.
    bool odd = false;
    double outline = 1e300;
    std::size_t first = 0;
    for (std::size_t ring = 0; ring <= g.ring_starts.size(); ++ring) {
        const std::size_t end = ring < g.ring_starts.size() ? g.ring_starts[ring] : g.points.size();
        const std::vector<Point> points(g.points.begin() + std::ptrdiff_t(first), g.points.begin() + std::ptrdiff_t(end));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const dvec2 a = points[i];
            const dvec2 b = points[(i + 1) % points.size()];
            if ((a.x <= p.x) == (b.x <= p.x)) continue;
            const double y = a.y + (b.y - a.y) * (p.x - a.x) / (b.x - a.x);
            if (y < p.y) odd = !odd;
        }
        outline = std::min(outline, to_outline(points, true, p));
        first = end;
    }
    return odd ? -outline : outline;
}

double distance(const Bitmap&, dvec2) { throw std::logic_error("a bitmap has no outline here"); }

}  // namespace

double exact_distance(const Shape& shape, Point p) {
    return std::visit([&](const auto& g) { return distance(g, p); }, shape.geometry);
}

FieldValue exact_field(const std::vector<Shape>& shapes, Point p, double far) {
    FieldValue result{far, -1};
    int topmost = -1;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const double d = exact_distance(shapes[i], p);
        if (d <= 0) topmost = static_cast<int>(i);
        // The later of two whose outlines coincide lies on top.
        if (d <= result.distance) result = {d, static_cast<int>(i)};
    }
    if (topmost >= 0) result.shape = topmost;
    return result;
}

bool is_tie(const std::vector<Shape>& shapes, Point p, double within) {
    double first = std::numeric_limits<double>::infinity();
    double second = first;
    for (const Shape& shape : shapes) {
        const double d = exact_distance(shape, p);
        if (std::abs(d) < within) return true;
        if (d < first) std::swap(first, second), first = d;
        else second = std::min(second, d);
    }
    return first > 0 && second - first < within;
}

}  // namespace penumbra::test
