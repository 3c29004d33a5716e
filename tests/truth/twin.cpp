// SPDX-License-Identifier: MIT
#include "tests/truth/twin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace penumbra::truth {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kTouch = 1e-9;

// Where a ray is inside one convex part (or between two crossings of a polygon).
struct Stay {
    double enter, leave;
    Point normal;  // at the entry
    Colour emission, albedo;
};

double dot_of(Point a, Point b) { return a.x * b.x + a.y * b.y; }

Point rotated(Point p, double degrees) {
    const double r = degrees * kPi / 180;
    return {p.x * std::cos(r) - p.y * std::sin(r), p.x * std::sin(r) + p.y * std::cos(r)};
}

struct Ray {
    Point p, d;
    const Shape& shape;
    std::vector<Stay>& out;

    void add(double enter, double leave, Point normal) const {
        if (leave >= 0 && enter <= leave) {
            out.push_back({enter, leave, normal / std::sqrt(dot_of(normal, normal)), shape.emission,
                           shape.albedo});
        }
    }
    // |R^-1 (x - center) / radii| <= 1
    void ellipse(Point center, Point radii, double degrees) const {
        const Point q = rotated(p - center, -degrees) / radii;
        const Point e = rotated(d, -degrees) / radii;
        const double a = dot_of(e, e), b = dot_of(q, e), c = dot_of(q, q) - 1;
        const double s = b * b - a * c;
        if (s < 0) return;
        const double t = (-b - std::sqrt(s)) / a;
        add(t, (-b + std::sqrt(s)) / a, rotated((q + e * t) / radii, degrees));
    }
    // Two slabs.
    void slabs(Point center, Point half, double degrees) const {
        const Point q = rotated(p - center, -degrees);
        const Point e = rotated(d, -degrees);
        double enter = -kFar, leave = kFar;
        Point normal(0);
        for (int axis = 0; axis < 2; ++axis) {
            if (e[axis] == 0) {
                if (std::abs(q[axis]) > half[axis]) return;
                continue;
            }
            const double t0 = (-half[axis] - q[axis]) / e[axis],
                         t1 = (half[axis] - q[axis]) / e[axis];
            if (std::min(t0, t1) > enter) {
                enter = std::min(t0, t1);
                normal = Point(0);
                normal[axis] = e[axis] > 0 ? -1 : 1;
            }
            leave = std::min(leave, std::max(t0, t1));
        }
        add(enter, leave, rotated(normal, degrees));
    }
    void capsule(Point a, Point b, double width) const {
        ellipse(a, Point(width / 2), 0);
        ellipse(b, Point(width / 2), 0);
        const Point along = b - a;
        const double size = std::hypot(along.x, along.y);
        if (size > 0)
            slabs(0.5 * (a + b), {size / 2, width / 2}, std::atan2(along.y, along.x) * 180 / kPi);
    }

    void operator()(const Circle& c) const { ellipse(c.center, Point(c.radius), 0); }
    void operator()(const Ellipse& e) const { ellipse(e.center, e.radii, e.rotation_deg); }
    void operator()(const Rect& r) const {
        const Point half = r.size * 0.5;
        const double k = r.corner_radius;
        slabs(r.center, half - Point(k, 0), r.rotation_deg);
        if (k == 0) return;
        slabs(r.center, half - Point(0, k), r.rotation_deg);
        for (const double x : {-1.0, 1.0}) {
            for (const double y : {-1.0, 1.0}) {
                ellipse(r.center + rotated(Point(x, y) * (half - Point(k)), r.rotation_deg),
                        Point(k), 0);
            }
        }
    }
    void operator()(const Line& l) const { capsule(l.from, l.to, l.width); }
    void operator()(const Polyline& l) const {
        for (std::size_t i = 0; i + 1 < l.points.size(); ++i)
            capsule(l.points[i], l.points[i + 1], l.width);
        if (l.closed) capsule(l.points.back(), l.points.front(), l.width);
    }
    void operator()(const Polygon& g) const {
        // All crossings of the whole line, in order: inside between the first and second, and so
        // on.
        std::vector<std::pair<double, Point>> crossings;
        for_each_edge(g, [&](Point from, Point to) {
            const Point a = from - p, b = to - p;
            const double side_a = d.x * a.y - d.y * a.x, side_b = d.x * b.y - d.y * b.x;
            if ((side_a > 0) == (side_b > 0)) return;
            const double f = side_a / (side_a - side_b);
            Point normal(b.y - a.y, a.x - b.x);
            if (dot_of(normal, d) > 0) normal = -normal;
            crossings.emplace_back(dot_of(a + (b - a) * f, d), normal);
        });
        std::sort(crossings.begin(), crossings.end(),
                  [](const auto& x, const auto& y) { return x.first < y.first; });
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
            add(crossings[i].first, crossings[i + 1].first, crossings[i].second);
        }
    }
    void operator()(const Bitmap& b) const {
        const auto decode = [](int v) {
            const double s = v / 255.0;
            return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        };
        const Point cell = b.size / Point(b.image->width, b.image->height);
        for (int y = 0; y < b.image->height; ++y) {
            for (int x = 0; x < b.image->width; ++x) {
                const std::uint8_t* t = &b.image->rgba[std::size_t(4 * (y * b.image->width + x))];
                if (t[3] / 255.0 < b.solid_above) continue;
                const std::size_t before = out.size();
                slabs(b.position + cell * Point(x + 0.5, y + 0.5), cell * 0.5, 0);
                if (out.size() == before) continue;
                const Colour colour(decode(t[0]), decode(t[1]), decode(t[2]));
                out.back().emission = b.as_albedo ? Colour(0) : colour * b.emission_scale;
                out.back().albedo = b.as_albedo ? colour : Colour(0);
            }
        }
    }
};

std::vector<Stay> stays(const Scene& scene, Point p, Point d) {
    std::vector<Stay> all;
    for (const Shape& shape : scene.shapes) std::visit(Ray{p, d, shape, all}, shape.geometry);
    return all;
}

}  // namespace

bool Twin::is_solid(Point p) const {
    for (const Stay& s : stays(scene_, p, {0.8, 0.6})) {
        if (s.enter <= kTouch && s.leave >= -kTouch) return true;
    }
    return false;
}

TwinHit Twin::hit(Point p, Point d) const {
    const ViewRect v = scene_.canvas.view_or_default();
    const double m = scene_.canvas.margin;
    double border = kFar;
    if (d.x > 0) border = std::min(border, (v.x + v.w + m - p.x) / d.x);
    if (d.x < 0) border = std::min(border, (v.x - m - p.x) / d.x);
    if (d.y > 0) border = std::min(border, (v.y + v.h + m - p.y) / d.y);
    if (d.y < 0) border = std::min(border, (v.y - m - p.y) / d.y);
    const std::vector<Stay> all = stays(scene_, p, d);
    double first = kFar;
    for (const Stay& s : all) {
        if (s.enter > 0) first = std::min(first, s.enter);
    }
    TwinHit made;
    if (first > border) return made;
    made.is_sky = false;
    made.distance = first;
    for (const Stay& s : all) {  // the last in the list that covers the point is on top
        if (s.enter > first + kTouch || s.leave < first - kTouch) continue;
        made.emission = s.emission;
        made.albedo = s.albedo;
        if (s.enter > first - kTouch) made.normal = s.normal;
    }
    return made;
}

Colour Twin::sky(Point d) const {
    const auto& stops = scene_.sky.gradient;
    if (stops.empty()) return scene_.sky.radiance;
    double angle = std::atan2(d.y, d.x) * 180 / kPi;
    if (angle < 0) angle += 360;
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const SkyStop& a = stops[i];
        SkyStop b = stops[(i + 1) % stops.size()];
        if (i + 1 == stops.size()) b.angle_deg += 360;
        const double t = angle < a.angle_deg ? angle + 360 : angle;
        if (t >= a.angle_deg && t < b.angle_deg) {
            return a.radiance +
                   (b.radiance - a.radiance) * ((t - a.angle_deg) / (b.angle_deg - a.angle_deg));
        }
    }
    return stops.back().radiance;
}

Colour Twin::lights_on(Point p, Point n) const {
    Colour sum(0);
    for (const Light& light : scene_.lights) {
        Point way(0);
        Colour strength(0);
        double reach = kFar;
        if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
            way = -rotated({1, 0}, sun->direction_deg);
            strength = sun->irradiance;
        } else {
            const auto& point = std::get<PointLight>(light);
            reach = std::hypot(point.position.x - p.x, point.position.y - p.y);
            way = (point.position - p) / reach;
            strength = point.intensity / reach;
        }
        const double cosine = dot_of(way, n);
        if (cosine <= 0) continue;
        const TwinHit blocker = hit(p, way);
        if (blocker.is_sky || blocker.distance > reach) sum += strength * cosine;
    }
    return sum;
}

Colour Twin::path(Point p, Point d, int bounces, std::mt19937_64& random) const {
    std::uniform_real_distribution<double> even(-1, 1);
    Colour sum(0), weight(1);
    for (int bounce = 0;; ++bounce) {
        const TwinHit found = hit(p, d);
        if (found.is_sky) return sum + weight * sky(d);
        sum += weight * found.emission;
        if (bounce == bounces || found.albedo == Colour(0)) return sum;
        weight *= found.albedo;
        // Off the surface, so that it does not hit itself. Density cos / 2: its sine is even.
        const Point n = found.normal;
        p = p + d * found.distance + n * 1e-7;
        sum += weight * 0.5 * lights_on(p, n);
        const double sine = even(random);
        d = n * std::sqrt(1 - sine * sine) + Point(-n.y, n.x) * sine;
    }
}

Scene random_scene(unsigned seed, int shapes) {
    std::mt19937_64 random(seed);
    const auto between = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    const auto point = [&] { return Point(between(-10, 110), between(-10, 90)); };
    const auto colour = [&] { return Colour(between(0, 1), between(0, 1), between(0, 1)); };
    Scene scene;
    scene.canvas.width = 100;
    scene.canvas.height = 80;
    scene.canvas.margin = seed % 3 == 0 ? 0 : between(0, 25);
    if (seed % 2 == 0)
        scene.sky.gradient = {{20, colour()}, {110, colour()}, {110, colour()}, {290, colour()}};
    else if (seed % 4 == 1)
        scene.sky.radiance = colour();
    for (int i = 0; i < shapes; ++i) {
        Shape shape;
        if (between(0, 1) < 0.6) shape.emission = colour() * between(0, 4);
        if (between(0, 1) < 0.7) shape.albedo = colour();
        switch (i % 7) {
            case 0:
                shape.geometry = Circle{point(), between(0.5, 14)};
                break;
            case 1:
                shape.geometry =
                    Ellipse{point(), {between(1, 20), between(1, 8)}, between(-180, 180)};
                break;
            case 2: {
                Rect rect{point(), {between(2, 30), between(2, 20)}, between(-180, 180), 0};
                if (i % 2 == 0)
                    rect.corner_radius = between(0, 0.5) * std::min(rect.size.x, rect.size.y);
                shape.geometry = rect;
                break;
            }
            case 3:
                shape.geometry = Line{point(), point(), between(0.5, 5)};
                break;
            case 4: {
                Polyline line;
                Point at = point();
                for (int k = 0; k < 5; ++k)
                    line.points.push_back(at = at + Point(between(-20, 20), between(-20, 20)));
                line.width = between(0.5, 6);
                line.closed = i % 2 == 0;
                shape.geometry = line;
                break;
            }
            case 5: {
                Polygon polygon;
                const Point at = point();
                const int count = 3 + int(between(0, 5));
                for (int k = 0; k < count; ++k)
                    polygon.points.push_back(at + Point(between(-15, 15), between(-15, 15)));
                shape.geometry = polygon;
                break;
            }
            default: {
                auto texels = std::make_shared<Texels>();
                texels->width = 6;
                texels->height = 4;
                for (int k = 0; k < 6 * 4; ++k) {
                    for (int c = 0; c < 3; ++c)
                        texels->rgba.push_back(std::uint8_t(between(0, 256)));
                    texels->rgba.push_back(between(0, 1) < 0.6 ? 255 : 0);
                }
                shape.geometry = Bitmap{texels,          point(), {between(4, 30), between(4, 20)},
                                        between(0.5, 3), 0.5,     i % 2 == 1};
                shape.emission = shape.albedo = Colour(0);
                break;
            }
        }
        scene.shapes.push_back(shape);
    }
    return scene;
}

}  // namespace penumbra::truth
