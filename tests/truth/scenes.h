// SPDX-License-Identifier: MIT
// Short ways to write scenes down.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/reference/solver.h"
#include "core/scene/scene.h"

namespace penumbra::truth {

constexpr double kPi = std::numbers::pi;

inline Scene empty_scene(int width = 100, int height = 100, double margin = 0) {
    Scene scene;
    scene.canvas.width = width;
    scene.canvas.height = height;
    scene.canvas.margin = margin;
    return scene;
}

inline void add(Scene& scene, const Geometry& geometry, Colour emission = Colour(0),
                Colour albedo = Colour(0)) {
    scene.shapes.push_back({geometry, emission, albedo});
}

inline Circle disc(Point center, double radius) { return {center, radius}; }
inline Rect box(Point center, Point size, double rotation = 0, double corner = 0) {
    return {center, size, rotation, corner};
}

inline double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }
inline double angle_to(Point from, Point to) { return std::atan2(to.y - from.y, to.x - from.x); }

// The angle that points span as seen from p, none of them more than a quarter turn off `towards`.
inline double span_of(Point p, Point towards, const std::vector<Point>& points) {
    double low = 0, high = 0;
    bool first = true;
    for (const Point& q : points) {
        const double a = std::remainder(angle_to(p, q) - angle_to(p, towards), 2 * kPi);
        low = first ? a : std::min(low, a);
        high = first ? a : std::max(high, a);
        first = false;
    }
    return high - low;
}

inline double phi(const Scene& scene, Point p, int channel = 0) {
    return reference::mean_radiance_at(scene, p)[channel];
}

}  // namespace penumbra::truth
