// SPDX-License-Identifier: MIT
#include "core/plan/pack.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "glsl/scene_records.h"

namespace penumbra {
namespace {

using glm::dvec2;
using glm::vec4;

// Half of the shortest step of a march (glsl/lib/march.glsl): thinner, and a ray could step over it.
constexpr double kSolidHalfThickness = 0.126;

// World units squared, by the even-odd rule: rings inside of an odd number of others are holes. Of rings that cross, about.
double polygon_area(const Polygon& polygon) {
    struct RingArea {
        Point from{0};
        double twice = 0;
        std::size_t first = 0, end = 0;
    };
    std::vector<RingArea> rings;
    std::size_t first = 0;
    for (std::size_t r = 0; r <= polygon.ring_starts.size(); ++r) {
        const std::size_t end = r < polygon.ring_starts.size() ? polygon.ring_starts[r] : polygon.points.size();
        if (end > first) rings.push_back({polygon.points[first], 0, first, end});
        first = end;
    }
    const auto each_edge = [&](const RingArea& ring, auto visit) {
        for (std::size_t i = ring.first; i < ring.end; ++i) visit(polygon.points[i], polygon.points[i + 1 < ring.end ? i + 1 : ring.first]);
    };
    for (RingArea& ring : rings)
        each_edge(ring, [&](Point a, Point b) { ring.twice += (a.x - ring.from.x) * (b.y - ring.from.y) - (b.x - ring.from.x) * (a.y - ring.from.y); });
    double area = 0;
    for (const RingArea& ring : rings) {
        bool hole = false;
        for (const RingArea& other : rings) {
            if (&other == &ring) continue;
            each_edge(other, [&](Point a, Point b) {
                if ((a.y > ring.from.y) != (b.y > ring.from.y) && ring.from.x < a.x + (ring.from.y - a.y) * (b.x - a.x) / (b.y - a.y)) hole = !hole;
            });
        }
        area += (hole ? -0.5 : 0.5) * std::abs(ring.twice);
    }
    return std::abs(area);
}

class Packer {
public:
    Packer(const Scene& scene, double radiance_scale) : frame_(scene.canvas), scale_(1.0 / radiance_scale) {
        for (const Shape& shape : scene.shapes) std::visit([&](const auto& g) { add(shape, g); }, shape.geometry);
        packed_.opaque = scene.shapes.size();
        if (!scene.media.empty()) add_media(scene);
    }

    PackedScene take() { return std::move(packed_); }

private:
    // A shape that is marched larger than it is shines as much less. From around, a convex shape is seen as wide as its
    // perimeter over pi (Cauchy), and growing by g adds 2 pi g to that.
    void record(const Shape& shape, int type, double half_thickness, double perimeter, vec4 a, vec4 b) {
        const double grow = thin_shape_growth(half_thickness);
        const double light = perimeter / (perimeter + 2 * std::numbers::pi * grow);
        const Colour e = shape.emission * scale_;
        packed_.shapes.push_back({float(type), float(grow), float(first_edge_), float(packed_.edges.size() - first_edge_)});
        packed_.shapes.push_back({float(e.r), float(e.g), float(e.b), float(light)});
        packed_.shapes.push_back(a);
        packed_.shapes.push_back(b);
        first_edge_ = packed_.edges.size();
    }

    // Of the shape packed last.
    void gradient(const Shape& shape, const std::vector<vec4>& shares) {
        vec4& own = packed_.shapes.back();
        own.x = float(shape.gradient.size());
        own.y = float(packed_.edges.size());
        packed_.edges.insert(packed_.edges.end(), shares.begin(), shares.end());
        for (const EmissionStop& stop : shape.gradient)
            packed_.edges.push_back(vec4(glm::vec3(stop.emission * scale_), float(stop.at)));
        first_edge_ = packed_.edges.size();
    }

    static vec4 join(dvec2 a, dvec2 b) { return {float(a.x), float(a.y), float(b.x), float(b.y)}; }
    static dvec2 turn(double degrees) {
        // Quarter turns are exact, so that a scene turned by 90 degrees gives the turned picture.
        const double quarters = degrees / 90.0;
        if (quarters == std::floor(quarters)) {
            const int q = static_cast<int>(std::fmod(std::fmod(quarters, 4.0) + 4.0, 4.0));
            constexpr double kCos[] = {1, 0, -1, 0};
            constexpr double kSin[] = {0, 1, 0, -1};
            return {kCos[q], kSin[q]};
        }
        const double angle = degrees * std::numbers::pi / 180.0;
        return {std::cos(angle), std::sin(angle)};
    }

    void add(const Shape& shape, const Circle& g) {
        const double r = frame_.length(g.radius);
        const dvec2 c = frame_.point(g.center);
        record(shape, glsl::kShapeCircle, r, 2 * std::numbers::pi * r, {float(c.x), float(c.y), float(r), 0}, vec4(0));
    }

    void add(const Shape& shape, const Ellipse& g) {
        const dvec2 radii = g.radii * frame_.pixels_per_unit;
        // Ramanujan's first formula.
        const double perimeter = std::numbers::pi * (3 * (radii.x + radii.y) - std::sqrt((3 * radii.x + radii.y) * (radii.x + 3 * radii.y)));
        record(shape, glsl::kShapeEllipse, std::min(radii.x, radii.y), perimeter, join(frame_.point(g.center), radii),
               join(turn(g.rotation_deg), dvec2(0)));
    }

    void add(const Shape& shape, const Rect& g) {
        const dvec2 half = 0.5 * g.size * frame_.pixels_per_unit;
        const double perimeter = 4 * (half.x + half.y) - (8 - 2 * std::numbers::pi) * frame_.length(g.corner_radius);
        record(shape, glsl::kShapeRect, std::min(half.x, half.y), perimeter, join(frame_.point(g.center), half),
               join(turn(g.rotation_deg), dvec2(frame_.length(g.corner_radius), 0)));
    }

    void add(const Shape& shape, const Line& g) {
        const double half = 0.5 * frame_.length(g.width);
        const double perimeter = 2 * frame_.length(glm::length(g.to - g.from)) + 2 * std::numbers::pi * half;
        record(shape, glsl::kShapeLine, half, perimeter, join(frame_.point(g.from), frame_.point(g.to)), {0, 0, float(half), 0});
        gradient(shape, {});
    }

    void add(const Shape& shape, const Polyline& g) {
        const vec4 box = add_stroke(g.points, g.closed);
        const double half = 0.5 * frame_.length(g.width);
        double length = 0;
        for (std::size_t i = first_edge_; i < packed_.edges.size(); ++i) {
            const vec4& e = packed_.edges[i];
            length += std::hypot(double(e.z) - double(e.x), double(e.w) - double(e.y));
        }
        record(shape, glsl::kShapePolyline, half, 2 * length + 2 * std::numbers::pi * half, box, {0, 0, float(half), 0});
        if (shape.gradient.empty()) return;
        const double whole = stroke_length(g);
        std::vector<vec4> shares;
        double run = 0;
        for_each_segment(g, [&](Point a, Point b) {
            const double next = run + glm::length(b - a);
            shares.push_back(whole > 0 ? vec4(run / whole, next / whole, 0, 0) : vec4(0));
            run = next;
        });
        if (shares.empty()) shares.push_back(vec4(0));
        gradient(shape, shares);
    }

    void add(const Shape& shape, const Polygon& g) {
        Box box;
        for_each_edge(g, [&](Point a, Point b) { add_edge(a, b, box); });
        double perimeter = 0;
        for (std::size_t i = first_edge_; i < packed_.edges.size(); ++i) {
            const vec4& e = packed_.edges[i];
            perimeter += std::hypot(double(e.z) - double(e.x), double(e.w) - double(e.y));
        }
        // How thick a polygon is where it is thinnest is not known; how thick it is on the whole is: a sliver is held.
        const double area = polygon_area(g) * frame_.pixels_per_unit * frame_.pixels_per_unit;
        record(shape, glsl::kShapePolygon, area / perimeter, perimeter, join(box.lo, box.hi), vec4(0));
    }

    void add(const Shape& shape, const Bitmap& g) {
        const std::size_t first = packed_.texels.size();
        const Texels& image = *g.image;
        const std::size_t count = image.rgba.size() / 4;
        packed_.texels.reserve(first + count);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint8_t* t = &image.rgba[4 * i];
            packed_.texels.push_back(std::uint32_t(t[0]) | std::uint32_t(t[1]) << 8 | std::uint32_t(t[2]) << 16 |
                                     std::uint32_t(t[3]) << 24);
        }
        // Half way between the last alpha that is free and the first that is solid.
        const double threshold = (std::ceil(g.solid_above * 255.0 - 1e-9) - 0.5) / 255.0;
        record(shape, glsl::kShapeBitmap, kSolidHalfThickness, 1,
               join(frame_.point(g.position), g.size * frame_.pixels_per_unit),
               {float(first), float(image.width), float(image.height), float(threshold)});
        packed_.shapes[packed_.shapes.size() - 3].w = float(g.as_albedo ? 0.0 : g.emission_scale * scale_);
    }

    // The box in pixels that a shape lies in.
    static vec4 box_of(const Shape& shape, const vec4& a, const vec4& b) {
        dvec2 middle(a.x, a.y), half(0);
        if (std::holds_alternative<Circle>(shape.geometry)) {
            half = dvec2(double(a.z));
        } else if (std::holds_alternative<Ellipse>(shape.geometry)) {
            half = {std::hypot(a.z * b.x, a.w * b.y), std::hypot(a.z * b.y, a.w * b.x)};
        } else if (std::holds_alternative<Rect>(shape.geometry)) {
            half = {std::abs(a.z * b.x) + std::abs(a.w * b.y), std::abs(a.z * b.y) + std::abs(a.w * b.x)};
        } else {
            // From end to end, or a box already; a stroke's half width more.
            middle = 0.5 * dvec2(a.x + a.z, a.y + a.w);
            half = 0.5 * glm::abs(dvec2(a.z - a.x, a.w - a.y)) + double(b.z);
        }
        return join(middle - half - 1e-3, middle + half + 1e-3);
    }

    void add_media(const Scene& scene) {
        const std::size_t first = packed_.shapes.size() / glsl::kShapeTexels;
        packed_.media.resize(2);
        vec4 all(1e30f, 1e30f, -1e30f, -1e30f);
        std::size_t edges = 0;
        for (const Shape& shape : scene.media) {
            Shape filled = shape;
            const double length = 1.0 / frame_.pixels_per_unit;  // world units in a pixel
            filled.emission = shape.medium->extinction * length / scale_;
            std::visit([&](const auto& g) { add(filled, g); }, shape.geometry);
            const vec4* record = &packed_.shapes[packed_.shapes.size() - glsl::kShapeTexels];
            edges += std::max<std::size_t>(static_cast<std::size_t>(record[0].w), 1);
            const vec4 box = box_of(shape, record[2], record[3]);
            all = {std::min(all.x, box.x), std::min(all.y, box.y), std::max(all.z, box.z), std::max(all.w, box.w)};
            const Colour e = shape.medium->emission * length * scale_;
            packed_.media.push_back({float(e.r), float(e.g), float(e.b), 0});
            packed_.media.push_back(box);
        }
        // What lies outside the domain does nothing.
        const GridPlan grid = plan_grid(scene.canvas);
        all = {std::max(all.x, float(grid.domain.x0)), std::max(all.y, float(grid.domain.y0)), std::min(all.z, float(grid.domain.x1)),
               std::min(all.w, float(grid.domain.y1))};
        packed_.media[0] = {float(first), float(scene.media.size()), float(edges + scene.media.size()), 0};
        packed_.media[1] = all;
    }

    struct Box {
        dvec2 lo{1e300};
        dvec2 hi{-1e300};
    };

    void add_edge(Point from, Point to, Box& box) {
        const dvec2 a = frame_.point(from);
        const dvec2 b = frame_.point(to);
        packed_.edges.push_back(join(a, b));
        box.lo = glm::min(box.lo, glm::min(a, b));
        box.hi = glm::max(box.hi, glm::max(a, b));
    }

    vec4 add_stroke(const std::vector<Point>& points, bool closed) {
        Box box;
        if (points.size() == 1) add_edge(points[0], points[0], box);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) add_edge(points[i], points[i + 1], box);
        if (closed && points.size() > 1) add_edge(points.back(), points.front(), box);
        return join(box.lo, box.hi);
    }

    PixelFrame frame_;
    double scale_;
    std::size_t first_edge_ = 0;  // of the shape being packed
    PackedScene packed_;
};

}  // namespace

PixelFrame::PixelFrame(const Canvas& canvas) {
    const ViewRect view = canvas.view_or_default();
    origin = {view.x, view.y};
    pixels_per_unit = canvas.width / view.w;
}

double thin_shape_growth(double half_thickness_px) { return std::max(0.0, kSolidHalfThickness - half_thickness_px); }

std::size_t edge_count(const Shape& shape) {
    if (const auto* line = std::get_if<Polyline>(&shape.geometry))
        return line->points.size() <= 1 ? 1 : line->points.size() - (line->closed ? 0 : 1);
    if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) return polygon->points.size();
    return 0;
}

PackedScene pack_scene(const Scene& scene, double radiance_scale) { return Packer(scene, radiance_scale).take(); }

}  // namespace penumbra
