// SPDX-License-Identifier: MIT
#include "tests/stability/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include <glm/common.hpp>

#include "core/scene/validate.h"
#include "tests/support/build_scene.h"

namespace penumbra::test {

Point Motion::operator()(Point p) const {
    p -= centre;
    if (mirrored) p.x = -p.x;
    const double a = turned_deg * std::numbers::pi / 180;
    return centre + by + scale * Point(std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y);
}

Geometry moved(const Geometry& geometry, const Motion& m) {
    struct Mover {
        const Motion& m;
        Geometry operator()(Circle g) const { return Circle{m(g.center), g.radius * m.scale}; }
        Geometry operator()(Ellipse g) const { return Ellipse{m(g.center), g.radii * m.scale, m.angle(g.rotation_deg)}; }
        Geometry operator()(Rect g) const { return Rect{m(g.center), g.size * m.scale, m.angle(g.rotation_deg), g.corner_radius * m.scale}; }
        Geometry operator()(Line g) const { return Line{m(g.from), m(g.to), g.width * m.scale}; }
        Geometry operator()(Polyline g) const {
            for (Point& p : g.points) p = m(p);
            g.width *= m.scale;
            return g;
        }
        Geometry operator()(Polygon g) const {
            for (Point& p : g.points) p = m(p);
            return g;
        }
        Geometry operator()(Bitmap g) const {
            g.position = m(g.position);
            g.size *= m.scale;
            return g;
        }
    };
    return std::visit(Mover{m}, geometry);
}

std::vector<Shape> moved(const std::vector<Shape>& shapes, const Motion& motion) {
    std::vector<Shape> result = shapes;
    for (Shape& one : result) one.geometry = moved(one.geometry, motion);
    return result;
}

std::vector<Shape> lamps_and_walls(Point centre, double unit) {
    const auto at = [&](double x, double y) { return centre + unit * Point(x, y); };
    return {shape(Circle{at(-0.42, -0.31), 0.11 * unit}, {3, 2, 1}),
            shape(Circle{at(-0.33, -0.27), 0.09 * unit}, {1, 2, 1}),
            shape(Rect{at(0.13, 0.05), {0.11 * unit, 0.7 * unit}, 12, 0.02 * unit}),
            shape(Ellipse{at(0.52, 0.33), {0.17 * unit, 0.08 * unit}, 40}, {0, 0.5, 2}),
            shape(Line{at(-0.3, 0.42), at(-0.1, 0.57), 0.05 * unit}, {0.3, 0.3, 0}),
            shape(Polygon{{at(-0.7, 0.2), at(-0.55, 0.28), at(-0.66, 0.5)}}),
            shape(Polyline{{at(0.4, -0.6), at(0.65, -0.45), at(0.45, -0.25)}, 0.06 * unit, false})};
}

namespace {

// Few sizes, since llvmpipe compiles every program anew for textures of one texel or whose sides are powers of two.
constexpr int kSizes[][2] = {{47, 31}, {31, 47}, {47, 31}, {45, 45}, {45, 45}, {16, 16}, {1, 31}, {1, 1}};
constexpr double kMargins[] = {3.7, 18, 52.3};

class Maker {
public:
    Maker(std::uint64_t seed, bool wild) : n_(seed * 7919 + (wild ? 3 : 11)), wild_(wild) {}

    Scene make() {
        const auto& size = kSizes[static_cast<std::size_t>(n_.next() * 8)];
        Scene scene = wild_ ? canvas(size[0], size[1]) : canvas(41, 41);
        width_ = scene.canvas.width;
        height_ = scene.canvas.height;
        if (one_in(3)) scene.sky.radiance = light();
        else if (one_in(4)) scene.sky = gradient();
        if (one_in(4)) scene.canvas.margin = kMargins[static_cast<std::size_t>(n_.next() * (wild_ ? 3 : 2))];
        reach_ = scene.canvas.margin + 6;
        const int count = 1 + static_cast<int>(std::pow(n_.next(), 2) * (wild_ && one_in(6) ? 120 : 14));
        for (int i = 0; i < count; ++i) add(scene);
        if (wild_ && one_in(8)) scene.shapes.push_back(shape(Rect{{width_ / 2, height_ / 2}, {width_ * n_.between(0.5, 3), height_ * n_.between(0.5, 3)}, 0, 0}, light()));
        // Other units and places: the view takes the scene along.
        if (wild_ && one_in(2)) {
            const double scale = std::pow(10.0, n_.between(-4, 5));
            const double far = one_in(2) ? 1e6 : 100;
            Motion m;
            m.scale = scale;
            m.by = {std::floor(n_.between(-far, far)), std::floor(n_.between(-far, far))};
            // No farther off than doubles can say: a millionth of a pixel.
            if (std::abs(far / scale) > 1e9) m.by = Point(0);
            scene.shapes = moved(scene.shapes, m);
            scene.canvas.view = ViewRect{m.by.x, m.by.y, width_ * scale, height_ * scale};
            scene.canvas.margin *= scale;
        }
        // A shape that the format refuses is left out.
        for (std::size_t i = scene.shapes.size(); i-- > 0;) {
            Scene alone = scene;
            alone.shapes = {scene.shapes[i]};
            if (!validate(alone).empty()) scene.shapes.erase(scene.shapes.begin() + static_cast<std::ptrdiff_t>(i));
        }
        return scene;
    }

private:
    bool one_in(int times) { return n_.next() * times < 1; }

    Colour light() {
        Colour c{n_.between(0, 2), n_.between(0, 2), n_.between(0, 2)};
        if (wild_ && one_in(3)) c *= std::pow(10.0, n_.between(-6, 6));
        if (one_in(4)) c[static_cast<int>(n_.next() * 3)] = 0;
        return c;
    }

    Sky gradient() {
        Sky sky;
        double angle = n_.between(0, 60);
        const int stops = 2 + static_cast<int>(n_.next() * 4);
        for (int i = 0; i < stops; ++i) {
            sky.gradient.push_back({angle, light()});
            if (one_in(3)) sky.gradient.push_back({angle, light()});
            angle += n_.between(1, 60);
        }
        return sky;
    }

    Point somewhere() {
        Point p{n_.between(-reach_, width_ + reach_), n_.between(-reach_, height_ + reach_)};
        if (wild_ && one_in(5)) p = glm::floor(p) + (one_in(2) ? 0.5 : 0.0);  // on the grid, or on pixels' centres
        return p;
    }

    double size() {
        if (!wild_) return 1.5 * std::pow(6.0, n_.next());
        if (one_in(3)) return std::pow(10.0, n_.between(-3, 2.3));
        return 0.4 * std::pow(30.0, n_.next());
    }

    Geometry geometry(Point at, double s) {
        const auto off = [&] { return Point(n_.between(-s, s), n_.between(-s, s)); };
        const double angle = wild_ && one_in(3) ? 45.0 * std::floor(n_.between(0, 8)) : n_.between(0, 360);
        const double thin = wild_ && one_in(4) ? std::pow(10.0, n_.between(-5, 0)) : n_.between(0.2, 1);
        switch (static_cast<int>(n_.next() * 7)) {
            case 0: return Circle{at, s};
            case 1: return Ellipse{at, {s, s * thin}, angle};
            case 2: return Rect{at, {2 * s, 2 * s * thin}, angle, one_in(2) ? 0 : n_.between(0, 1) * s * thin};
            case 3: return Line{at, wild_ && one_in(6) ? at : at + 2.0 * off(), s * 0.6 * thin};
            case 4: {
                Polyline g{{at}, s * 0.4 * thin, one_in(3)};
                for (int i = 0; i < 2 + static_cast<int>(n_.next() * 5); ++i) g.points.push_back(g.points.back() + off());
                if (wild_ && one_in(3)) g.points.insert(g.points.begin() + 1, g.points[0]);                          // a repeated point
                if (wild_ && one_in(3)) g.points.push_back(0.5 * (g.points.back() + g.points[g.points.size() - 2]));  // back on itself
                return g;
            }
            case 5: {
                Polygon g{{at + off(), at + off(), at + off()}};
                for (int i = 0; i < static_cast<int>(n_.next() * 5); ++i) g.points.push_back(at + off());
                if (wild_ && one_in(3)) g.points.push_back(g.points.back());
                if (wild_ && one_in(3)) g.points.insert(g.points.begin() + 1, 0.5 * (g.points[0] + g.points[1]));    // in line with its neighbours
                return g;
            }
            default: {
                const int modulus = 1 + static_cast<int>(n_.next() * 4);
                const int w = 1 + static_cast<int>(n_.next() * 6), h = 1 + static_cast<int>(n_.next() * 5);
                return Bitmap{picture(w, h, [&](int x, int y) { return modulus == 1 || (3 * x + 2 * y) % modulus != 0; }), at,
                              {0.25 * s * w, 0.25 * s * h}, n_.between(0, 2), 0.5, one_in(2)};
            }
        }
    }

    void add(Scene& scene) {
        Shape one = shape(geometry(somewhere(), size()), one_in(2) ? light() : Colour(0));
        if (!scene.shapes.empty() && one_in(wild_ ? 6 : 20)) {
            // A twin of an earlier one, in the same place or beside it.
            const Geometry twin = scene.shapes[static_cast<std::size_t>(n_.next() * double(scene.shapes.size()))].geometry;
            Motion beside;
            if (one_in(2)) beside.by = {n_.between(0, 3), 0};
            one.geometry = moved(twin, beside);
        }
        scene.shapes.push_back(std::move(one));
    }

    Numbers n_;
    bool wild_;
    double width_ = 0, height_ = 0, reach_ = 0;
};

double rounded(double v, double step) { return std::round(v / step) * step; }

void round_lengths(Geometry& geometry, double step) {
    const auto point = [&](Point& p) { p = {rounded(p.x, step), rounded(p.y, step)}; };
    const auto length = [&](double& v) { if (v > 4 * step) v = rounded(v, step); };
    if (auto* c = std::get_if<Circle>(&geometry)) point(c->center), length(c->radius);
    if (auto* e = std::get_if<Ellipse>(&geometry)) point(e->center), length(e->radii.x), length(e->radii.y), e->rotation_deg = rounded(e->rotation_deg, 10 * step);
    if (auto* r = std::get_if<Rect>(&geometry)) point(r->center), length(r->size.x), length(r->size.y), r->rotation_deg = rounded(r->rotation_deg, 10 * step);
    if (auto* l = std::get_if<Line>(&geometry)) point(l->from), point(l->to), length(l->width);
    if (auto* p = std::get_if<Polyline>(&geometry)) { for (Point& q : p->points) point(q); length(p->width); }
    if (auto* p = std::get_if<Polygon>(&geometry)) for (Point& q : p->points) point(q);
    if (auto* b = std::get_if<Bitmap>(&geometry)) point(b->position), length(b->size.x), length(b->size.y);
}

}  // namespace

Scene mild_scene(std::uint64_t seed) { return Maker(seed, false).make(); }
Scene wild_scene(std::uint64_t seed) { return Maker(seed, true).make(); }

Scene shrunk(Scene scene, const std::function<std::string(const Scene&)>& fails) {
    const auto still = [&](const Scene& smaller) {
        if (!validate(smaller).empty()) return false;
        try {
            return !fails(smaller).empty();
        } catch (const std::exception&) {
            return false;
        }
    };
    const auto attempt = [&](const std::function<void(Scene&)>& change) {
        Scene smaller = scene;
        change(smaller);
        if (!still(smaller)) return false;
        scene = std::move(smaller);
        return true;
    };
    // Shapes, in halves, quarters, one by one.
    for (std::size_t run = std::max<std::size_t>(scene.shapes.size() / 2, 1);; run /= 2) {
        for (std::size_t i = 0; i + run <= scene.shapes.size();)
            if (!attempt([&](Scene& s) { s.shapes.erase(s.shapes.begin() + std::ptrdiff_t(i), s.shapes.begin() + std::ptrdiff_t(i + run)); })) i += run;
        if (run <= 1) break;
    }
    attempt([](Scene& s) { s.sky = {}; });
    attempt([](Scene& s) { s.canvas.margin = 0; });
    for (std::size_t i = 0; i < scene.sky.gradient.size();)
        if (!attempt([&](Scene& s) { s.sky.gradient.erase(s.sky.gradient.begin() + std::ptrdiff_t(i)); })) ++i;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        attempt([&](Scene& s) { s.shapes[i].emission = Colour(0); });
        attempt([&](Scene& s) { if (s.shapes[i].emission != Colour(0)) s.shapes[i].emission = Colour(1); });
        const auto points_of = [](Geometry& g) -> std::vector<Point>* {
            if (auto* line = std::get_if<Polyline>(&g)) return &line->points;
            if (auto* polygon = std::get_if<Polygon>(&g)) return &polygon->points;
            return nullptr;
        };
        if (const auto* points = points_of(scene.shapes[i].geometry))
            for (std::size_t k = points->size(); k-- > 0;)
                attempt([&](Scene& s) { auto* list = points_of(s.shapes[i].geometry); list->erase(list->begin() + std::ptrdiff_t(k)); });
        const double pixel = scene.canvas.pixel_size();
        for (const double step : {0.01, 0.1, 1.0})
            if (!attempt([&](Scene& s) { round_lengths(s.shapes[i].geometry, step * pixel); })) break;
    }
    return scene;
}

}  // namespace penumbra::test
