// SPDX-License-Identifier: MIT
#include "core/reference/outlines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

Point direction_of(double degrees) {
    // Quarter turns come out exact, so that unrotated and upright shapes have exact corners.
    const double turns = std::remainder(degrees, 360.0);
    if (turns == 0) return {1, 0};
    if (turns == 90) return {0, 1};
    if (turns == -90) return {0, -1};
    if (turns == 180 || turns == -180) return {-1, 0};
    const double radians = turns * kPi / 180;
    return {std::cos(radians), std::sin(radians)};
}

int add_material(Outlines& out, const Shape& shape) {
    Material material;
    material.emission = shape.emission;
    material.albedo = shape.albedo;
    out.materials.push_back(material);
    return int(out.materials.size()) - 1;
}

void add_piece(Outlines& out, Piece piece, int body) {
    piece.body = body;
    piece.material = out.bodies[std::size_t(body)].material;
    out.pieces.push_back(piece);
}

int add_body(Outlines& out, Body body) {
    out.bodies.push_back(std::move(body));
    return int(out.bodies.size()) - 1;
}

void add_ellipse(Outlines& out, Body body, Point center, Point u, Point v) {
    const Piece ring = arc_piece(center, u, v, 0, 2 * kPi);
    body.kind = Body::Kind::ellipse;
    body.center = center;
    body.inverse_u = ring.inverse_u;
    body.inverse_v = ring.inverse_v;
    body.box = ring.box();
    add_piece(out, ring, add_body(out, std::move(body)));
}

void add_rect(Outlines& out, Body body, const Rect& rect) {
    const Point along = direction_of(rect.rotation_deg);
    const Point across{-along.y, along.x};
    const double r = rect.corner_radius;
    body.kind = Body::Kind::rounded_rect;
    body.center = rect.center;
    body.axis = along;
    body.radius = r;
    body.half_size = rect.size * 0.5 - Point(r);
    const Point h = body.half_size;
    // The centres of the corners' circles, in the order in which the outline passes them.
    const Point inner[4] = {
        rect.center - along * h.x - across * h.y, rect.center + along * h.x - across * h.y,
        rect.center + along * h.x + across * h.y, rect.center - along * h.x + across * h.y};
    const Point outward[4] = {-across, along, across, -along};  // of the side after corner i
    for (const Point& corner : inner) {
        body.box.add(corner - Point(r * (std::abs(along.x) + std::abs(along.y))));
        body.box.add(corner + Point(r * (std::abs(along.x) + std::abs(along.y))));
    }
    const int index = add_body(out, std::move(body));
    for (int i = 0; i < 4; ++i) {
        const int next = (i + 1) % 4;
        const Point a = inner[i] + outward[i] * r;
        const Point b = inner[next] + outward[i] * r;
        // A side that the rounding has eaten up leaves no piece.
        const double side = i % 2 == 0 ? h.x : h.y;
        if (side > 0) add_piece(out, straight_piece(a, b), index);
        if (r > 0) {
            Piece corner = arc_piece(inner[next], outward[i] * r, outward[next] * r, 0, kPi / 2);
            corner.a = b;
            corner.b = inner[next] + outward[next] * r;
            add_piece(out, corner, index);
        }
    }
}

// Emission at a share of a stroke's length; of the two of a step, that `before` it or the other.
Colour emission_along(const std::vector<EmissionStop>& stops, double at, bool before) {
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const EmissionStop& stop = stops[i];
        if (before ? stop.at < at : stop.at <= at) continue;
        if (i == 0) return stop.emission;
        const EmissionStop& last = stops[i - 1];
        return last.emission + (stop.emission - last.emission) * ((at - last.at) / (stop.at - last.at));
    }
    return stops.back().emission;
}

// The parts of a capsule between the stops of its stroke's gradient: it goes from the share s0 to s1 of the stroke's length.
void add_parts(Outlines& out, Body& body, const Shape& shape, Point from, Point to, double s0, double s1) {
    std::vector<double> ends;
    for (const EmissionStop& stop : shape.gradient)
        if (stop.at > s0 && stop.at < s1 && (ends.empty() || stop.at > ends.back())) ends.push_back(stop.at);
    ends.push_back(s1);
    const double reach = std::sqrt(length_squared(to - from));
    double start = s0;
    for (const double end : ends) {
        Material material;
        material.albedo = shape.albedo;
        material.emission = emission_along(shape.gradient, start, false);
        material.origin = s1 > s0 ? from + (to - from) * ((start - s0) / (s1 - s0)) : from;
        material.axis = reach > 0 ? (to - from) / reach : Point(1, 0);
        if (end > start) {
            const double length = reach * (end - start) / (s1 - s0);
            material.slope = (emission_along(shape.gradient, end, true) - material.emission) / length;
        }
        out.materials.push_back(material);
        body.parts.push_back({s1 > s0 ? (end - s0) / (s1 - s0) : 1.0, int(out.materials.size()) - 1});
        start = end;
    }
}

// Light of the round end that begins or ends a capsule: that of its end.
int end_material(Outlines& out, const Body& body, Point end) {
    if (body.parts.empty()) return body.material;
    Material material = out.materials[std::size_t(body.material_at(end))];
    material.emission = material.emission_at(end);
    material.slope = Colour(0);
    out.materials.push_back(material);
    return int(out.materials.size()) - 1;
}

// A straight side from `a` to `b`, whose places along the capsule are u0 and u1; cut where its light changes.
void add_side(Outlines& out, int body, Point a, Point b, double u0, double u1) {
    const std::vector<Body::Part> parts = out.bodies[std::size_t(body)].parts;
    if (parts.empty()) {
        add_piece(out, straight_piece(a, b), body);
        return;
    }
    double start = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Body::Part& part = u0 < u1 ? parts[i] : parts[parts.size() - 1 - i];
        const std::size_t after = parts.size() - 1 - i;
        const double end = u0 < u1 ? part.end : after == 0 ? 1.0 : 1 - parts[after - 1].end;
        Piece piece = straight_piece(start == 0 ? a : a + (b - a) * start, end >= 1 ? b : a + (b - a) * end);
        piece.body = body;
        piece.material = part.material;
        out.pieces.push_back(piece);
        start = end;
    }
}

void add_capsule(Outlines& out, Body body, Point from, Point to, double width) {
    const double r = width / 2;
    const double reach = std::sqrt(length_squared(to - from));
    if (reach == 0) {
        if (!body.parts.empty()) {
            body.material = body.parts.front().material;
            body.parts.clear();
        }
        add_ellipse(out, std::move(body), from, {r, 0}, {0, r});
        return;
    }
    body.kind = Body::Kind::capsule;
    body.center = from;
    body.axis = to - from;
    body.radius = r;
    body.box.add(from);
    body.box.add(to);
    body.box = body.box.grown(r);
    const int index = add_body(out, std::move(body));
    const Point along = (to - from) / reach;
    const Point side = turned(along) * r;  // of the straight piece that runs from `from` to `to`
    const auto add_cap = [&](Piece cap, Point end) {
        cap.body = index;
        cap.material = end_material(out, out.bodies[std::size_t(index)], end);
        out.pieces.push_back(cap);
    };
    add_side(out, index, from + side, to + side, 0, 1);
    Piece cap = arc_piece(to, side, along * r, 0, kPi);
    cap.a = to + side;
    cap.b = to - side;
    add_cap(cap, to);
    add_side(out, index, to - side, from - side, 1, 0);
    cap = arc_piece(from, -side, -along * r, 0, kPi);
    cap.a = from - side;
    cap.b = from + side;
    add_cap(cap, from);
}

void add_polygon(Outlines& out, Body body, const Polygon& polygon) {
    body.kind = Body::Kind::polygon;
    body.polygon = polygon;
    for (const Point& p : polygon.points) body.box.add(p);
    const int index = add_body(out, std::move(body));
    for_each_edge(polygon, [&](Point a, Point b) {
        // Which side is solid is found after splitting: even-odd may turn it along one edge.
        if (a != b) add_piece(out, straight_piece(a, b), index);
    });
}

struct Adder {
    Outlines& out;
    const Shape& shape;
    int index;
    std::size_t max_pieces;

    Body body() const {
        Body made;
        made.shape = index;
        made.material = add_material(out, shape);
        return made;
    }
    void operator()(const Circle& c) const {
        add_ellipse(out, body(), c.center, {c.radius, 0}, {0, c.radius});
    }
    void operator()(const Ellipse& e) const {
        const Point along = direction_of(e.rotation_deg);
        add_ellipse(out, body(), e.center, along * e.radii.x, Point(-along.y, along.x) * e.radii.y);
    }
    void operator()(const Rect& r) const { add_rect(out, body(), r); }
    // The part of a stroke from the share s0 of its length to s1.
    void capsule(Body made, Point from, Point to, double width, double s0, double s1) const {
        if (!shape.gradient.empty()) add_parts(out, made, shape, from, to, s0, s1);
        add_capsule(out, std::move(made), from, to, width);
    }
    void operator()(const Line& l) const { capsule(body(), l.from, l.to, l.width, 0, l.from == l.to ? 0 : 1); }
    void operator()(const Polyline& p) const {
        const Body made = body();
        const std::size_t n = p.points.size();
        if (n == 1) capsule(made, p.points[0], p.points[0], p.width, 0, 0);
        const double whole = stroke_length(p);
        double run = 0;
        for_each_segment(p, [&](Point a, Point b) {
            const double next = run + std::sqrt(length_squared(b - a));
            capsule(made, a, b, p.width, whole > 0 ? run / whole : 0, whole > 0 ? next / whole : 0);
            run = next;
        });
    }
    void operator()(const Polygon& p) const { add_polygon(out, body(), p); }
    void operator()(const Bitmap& b) const { add_bitmap(b, index, max_pieces, out); }
};

bool polygon_contains(const Polygon& polygon, Point p) {
    bool inside = false;
    bool on_outline = false;
    for_each_edge(polygon, [&](Point a, Point b) {
        if ((a.y > p.y) == (b.y > p.y)) {
            // The outline belongs to the shape: a level edge or a vertex under the point counts.
            const bool level = a.y == p.y && b.y == p.y && p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x);
            on_outline = on_outline || level || p == a;
            return;
        }
        const double side = cross(b - a, p - a);
        on_outline = on_outline || side == 0;
        if ((side > 0) == (b.y > a.y)) inside = !inside;
    });
    return inside || on_outline;
}

}  // namespace

Point Piece::at(double t) const {
    if (t == t0) return a;
    if (t == t1) return b;
    if (is_arc) return center + u * std::cos(t) + v * std::sin(t);
    return a + (b - a) * ((t - t0) / (t1 - t0));
}

Point Piece::tangent(double t) const {
    if (is_arc) return v * std::cos(t) - u * std::sin(t);
    return b - a;
}

double Piece::parameter_of(Point p) const {
    if (is_arc) {
        const Point q = to_frame(p);
        double t = std::atan2(q.y, q.x);
        // Into [t0 - slack, ...): parameters just below t0 stay below, so both ends work.
        const double middle = 0.5 * (t0 + t1);
        t += 2 * kPi * std::round((middle - t) / (2 * kPi));
        return t;
    }
    const Point d = b - a;
    return t0 + (t1 - t0) * dot(p - a, d) / length_squared(d);
}

Box Piece::box() const {
    Box box;
    box.add(a);
    box.add(b);
    if (is_arc) {
        // Extremes of the whole ellipse in x and y, where they lie on the arc.
        const double tops[2] = {std::atan2(v.x, u.x), std::atan2(v.y, u.y)};
        for (const double top : tops) {
            for (int k = -6; k <= 6; ++k) {
                const double t = top + k * kPi;
                if (t > t0 && t < t1) box.add(center + u * std::cos(t) + v * std::sin(t));
            }
        }
    }
    return box;
}

Piece straight_piece(Point a, Point b) {
    Piece piece;
    piece.a = a;
    piece.b = b;
    return piece;
}

Piece arc_piece(Point center, Point u, Point v, double t0, double t1) {
    Piece piece;
    piece.is_arc = true;
    piece.is_full = t1 - t0 >= 2 * kPi;
    piece.center = center;
    piece.u = u;
    piece.v = v;
    const double determinant = cross(u, v);
    piece.inverse_u = Point(v.y, -v.x) / determinant;
    piece.inverse_v = Point(-u.y, u.x) / determinant;
    piece.t0 = t0;
    piece.t1 = t1;
    piece.e0 = {std::cos(t0), std::sin(t0)};
    piece.e1 = piece.is_full ? piece.e0 : Point(std::cos(t1), std::sin(t1));
    piece.a = center + u * piece.e0.x + v * piece.e0.y;
    piece.b = center + u * piece.e1.x + v * piece.e1.y;
    return piece;
}

bool Body::contains(Point p) const {
    if (!box.contains(p)) return false;
    switch (kind) {
        case Kind::ellipse: {
            const Point d = p - center;
            const Point q{dot(inverse_u, d), dot(inverse_v, d)};
            return length_squared(q) <= 1;
        }
        case Kind::rounded_rect: {
            const Point d = p - center;
            const Point q{std::abs(dot(d, axis)) - half_size.x,
                          std::abs(cross(axis, d)) - half_size.y};
            const Point beyond{std::max(q.x, 0.0), std::max(q.y, 0.0)};
            return length_squared(beyond) <= radius * radius;
        }
        case Kind::capsule: {
            const Point d = p - center;
            const double t = std::clamp(dot(d, axis) / length_squared(axis), 0.0, 1.0);
            return length_squared(d - axis * t) <= radius * radius;
        }
        case Kind::polygon:
            return polygon_contains(polygon, p);
        case Kind::bitmap:
            return material_at(p) >= 0;
    }
    return false;
}

int Body::material_at(Point p) const {
    if (!parts.empty()) {
        const double u = dot(p - center, axis) / length_squared(axis);
        for (const Part& part : parts)
            if (u < part.end) return part.material;
        return parts.back().material;
    }
    if (kind != Kind::bitmap) return material;
    // The right and lower border belong to the last texels. A point between two texels is solid
    // when either is (texels are closed squares).
    const Point q = (p - center) / half_size;
    int found = -1;
    for (const double x : {std::ceil(q.x) - 1, std::floor(q.x)}) {
        for (const double y : {std::ceil(q.y) - 1, std::floor(q.y)}) {
            if (x < 0 || y < 0 || x >= texels_x || y >= texels_y) continue;
            found = std::max(
                found,
                int(texel_material[std::size_t(y) * std::size_t(texels_x) + std::size_t(x)]));
        }
    }
    return found;
}

Outlines outlines_of(const Scene& scene, std::size_t max_pieces) {
    Outlines out;
    for (std::size_t i = 0; i < scene.shapes.size() && out.problems.empty(); ++i) {
        const Shape& shape = scene.shapes[i];
        std::visit(Adder{out, shape, int(i), max_pieces}, shape.geometry);
        if (out.pieces.size() > max_pieces && out.problems.empty()) {
            out.problems.push_back({"/shapes/" + std::to_string(i), "too_many_pieces",
                                    "The exact solver takes outlines of at most " +
                                        std::to_string(max_pieces) +
                                        " pieces in all, and this shape goes beyond."});
        }
    }
    return out;
}

}  // namespace penumbra::reference
