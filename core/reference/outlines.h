// SPDX-License-Identifier: MIT
// Shapes as bodies (which points they cover) and as outline pieces (straight pieces and arcs of
// ellipses), in double precision. The raw material of the exact solver.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/scene/problem.h"
#include "core/scene/scene.h"

namespace penumbra::reference {

inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
inline double length_squared(Point a) { return dot(a, a); }
// The right-hand turn of a direction; the outward normal of a piece is the turn of its tangent.
inline Point turned(Point d) { return {d.y, -d.x}; }

struct Box {
    Point low{std::numeric_limits<double>::infinity()};
    Point high{-std::numeric_limits<double>::infinity()};

    void add(Point p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    Box grown(double by) const { return {low - Point(by), high + Point(by)}; }
    bool contains(Point p) const {
        return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y;
    }
    bool meets(const Box& o) const {
        return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
    }
};

struct Material {
    Colour emission{0};
    Colour albedo{0};
    // Of a stroke with a gradient: emission changes by this much per world unit along `axis`, a unit vector, and is `emission` at
    // `origin`.
    Colour slope{0};
    Point origin{0}, axis{0};

    bool operator==(const Material&) const = default;
    bool shines() const { return emission != Colour(0) || slope != Colour(0); }
    Colour emission_at(Point p) const { return emission + slope * dot(p - origin, axis); }
};

// A straight piece from `a` to `b`, or the arc center + cos(t) u + sin(t) v for t in [t0, t1].
// Solid lies on the left of the direction of travel (u, v have a positive determinant), so the
// outward normal is turned(tangent) and an observer in free space who turns towards growing angles
// sees a piece from `b` to `a`. Arcs are always convex towards free space.
struct Piece {
    bool is_arc = false;
    bool is_full = false;  // a whole ellipse: t1 = t0 + 2 pi
    int body = -1;
    int material = 0;
    Point a{0}, b{0};
    Point center{0}, u{0}, v{0};
    Point inverse_u{0}, inverse_v{0};  // rows of the inverse of the matrix with columns u, v
    double t0 = 0, t1 = 1;             // straight pieces: fractions of the way from a to b
    Point e0{0}, e1{0};                // arcs: (cos, sin) of t0 and t1

    // Into the frame where the arc's ellipse is the unit circle.
    Point to_frame(Point p) const { return vector_to_frame(p - center); }
    Point vector_to_frame(Point d) const { return {dot(inverse_u, d), dot(inverse_v, d)}; }
    Point at(double t) const;
    Point tangent(double t) const;       // not normalised
    double parameter_of(Point p) const;  // of a point on the piece's line or ellipse
    Box box() const;
};

Piece straight_piece(Point a, Point b);
Piece arc_piece(Point center, Point u, Point v, double t0, double t1);

// One closed region: a shape, or one capsule of a polyline.
struct Body {
    enum class Kind { ellipse, rounded_rect, capsule, polygon, bitmap };

    Kind kind = Kind::ellipse;
    int shape = 0;     // index in the scene's list: the later lies on top
    int material = 0;  // bitmaps: see `texel_material`
    Box box;
    Point center{0};   // capsule: one end; bitmap: top left corner
    Point axis{1, 0};  // rect: unit direction of its width; capsule: to the other end
    Point inverse_u{0}, inverse_v{0};  // ellipse
    Point half_size{0};         // rect: without the corner's rounding; bitmap: size of a texel
    double radius = 0;          // capsule, rect's corner
    Polygon polygon;
    // Capsule of a stroke with a gradient: parts along it from 0 to 1, each to where it ends, with its material. Empty: one material.
    struct Part {
        double end = 1;
        int material = 0;
    };
    std::vector<Part> parts;
    int texels_x = 0, texels_y = 0;
    std::vector<std::int32_t> texel_material;  // bitmap: -1 where it is not solid

    bool contains(Point p) const;
    int material_at(Point p) const;  // of a point that it contains
};

struct Outlines {
    std::vector<Body> bodies;
    std::vector<Material> materials;
    std::vector<Piece> pieces;  // raw: neither clipped nor split
    Problems problems;
};

// Every shape of the scene. `max_pieces` bounds the work; a scene beyond it is a problem.
Outlines outlines_of(const Scene& scene, std::size_t max_pieces);

// Adds a bitmap's body and the outline of its solid texels (squares, or rectangles where the
// picture is stretched).
void add_bitmap(const Bitmap& bitmap, int shape, std::size_t max_pieces, Outlines& out);

// Encoded sRGB (0 to 1) to linear, IEC 61966-2-1.
double srgb_to_linear(double encoded);

}  // namespace penumbra::reference
