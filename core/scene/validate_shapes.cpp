// SPDX-License-Identifier: MIT
#include "core/scene/validate_shapes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "core/scene/wording.h"

namespace penumbra {

namespace {

// One shape's geometry; `index_` is for the messages that must name the shape.
class GeometryChecks {
public:
    GeometryChecks(RangeChecks& checks, const Path& where, std::size_t index)
        : checks_(checks), where_(where), index_(index) {}

    void operator()(const Circle& circle) {
        checks_.coordinates(where_.key("center"), circle.center);
        side(where_.key("radius"), circle.radius);
    }

    void operator()(const Ellipse& ellipse) {
        checks_.coordinates(where_.key("center"), ellipse.center);
        const Path radii = where_.key("radii");
        side(radii.index(0), ellipse.radii.x);
        side(radii.index(1), ellipse.radii.y);
        checks_.finite(where_.key("rotation"), ellipse.rotation_deg);
    }

    void operator()(const Rect& rect) {
        checks_.coordinates(where_.key("center"), rect.center);
        const bool sides_good = sides(where_.key("size"), rect.size);
        checks_.finite(where_.key("rotation"), rect.rotation_deg);
        const Path corner = where_.key("corner_radius");
        if (!checks_.at_least(corner, rect.corner_radius, 0) || !sides_good) {
            return;
        }
        const double most = std::min(rect.size.x, rect.size.y) / 2;
        if (rect.corner_radius > most) {
            checks_.add(corner, "out_of_range",
                        "must be at most half the shorter side, " + number_text(most) + ", is " +
                            number_text(rect.corner_radius));
        }
    }

    void operator()(const Line& line) {
        checks_.coordinates(where_.key("from"), line.from);
        checks_.coordinates(where_.key("to"), line.to);
        side(where_.key("width"), line.width);
    }

    void operator()(const Polyline& polyline) {
        points(where_.key("points"), polyline.points, 2);
        side(where_.key("width"), polyline.width);
    }

    void operator()(const Polygon& polygon) {
        const bool drawn = polygon.key != OutlineKey::points;
        const Path where = where_.key(polygon.key == OutlineKey::d ? "d" : polygon.key == OutlineKey::text ? "text" : "points");
        if (drawn && polygon.points.empty()) {
            checks_.add(where, "zero_area", "must enclose something: " + name() + " would have no area");
            return;
        }
        if (!points(where, polygon.points, 3, drawn)) {
            return;
        }
        if (fewer_than_three_distinct(polygon.points)) {
            checks_.add(where, "zero_area",
                        "must hold at least 3 distinct points: " + name() + " would have no area");
        } else if (in_a_line(polygon.points)) {
            checks_.add(where, "zero_area",
                        "must not all lie in a line: " + name() + " would have no area");
        }
    }

    void operator()(const Bitmap& bitmap) {
        if (!bitmap.image || bitmap.image->width <= 0 || bitmap.image->height <= 0) {
            checks_.add(
                where_.key("image"), "zero_area",
                "must be a picture of at least one texel: " + name() + " would have no area");
        } else {
            const int high = checks_.limits().max_bitmap_side_px;
            const Texels& texels = *bitmap.image;
            if (texels.width > high || texels.height > high) {
                checks_.add(where_.key("image"), "too_large",
                            "must be at most " + std::to_string(high) + " texels on a side, is " +
                                std::to_string(texels.width) + " x " +
                                std::to_string(texels.height));
            }
        }
        checks_.coordinates(where_.key("position"), bitmap.position);
        sides(where_.key("size"), bitmap.size);
        // Colours end at 1, so that the scale bounds the emission or the albedo.
        const double high = bitmap.as_albedo ? 1 : checks_.limits().max_radiance;
        checks_.between(where_.key("emission_scale"), bitmap.emission_scale, 0, high);
        checks_.between(where_.key("solid_above"), bitmap.solid_above, 0, 1);
    }

private:
    std::string name() const { return "shape " + std::to_string(index_); }

    bool side(const Path& where, double value) {
        if (value == 0) {
            checks_.add(where, "zero_area",
                        "must be more than 0, is 0: " + name() + " would have no area");
            return false;
        }
        return checks_.positive_length(where, value);
    }

    bool sides(const Path& where, const glm::dvec2& size) {
        const bool x = side(where.index(0), size.x);
        const bool y = side(where.index(1), size.y);
        return x && y;
    }

    // A path's or a text's points come of computing: a problem with one is a problem of the whole.
    bool points(const Path& where, const std::vector<Point>& list, std::size_t fewest, bool drawn = false) {
        const std::size_t most = checks_.limits().max_points_per_shape;
        if (!checks_.count(where, list.size(), most, "points")) {
            return false;
        }
        if (list.size() < fewest) {
            // An outline of no length has no area either, a stroke of one point is most likely a
            // slip.
            checks_.add(where, fewest == 3 ? "zero_area" : "too_few",
                        "must hold at least " + std::to_string(fewest) + " points, holds " +
                            std::to_string(list.size()) +
                            (fewest == 3 ? ": " + name() + " would have no area" : std::string()));
            return false;
        }
        if (drawn) {
            const auto far = std::find_if_not(list.begin(), list.end(), [&](const Point& p) {
                const double high = checks_.limits().max_coordinate;
                return std::abs(p.x) <= high && std::abs(p.y) <= high;
            });
            if (far == list.end()) {
                return true;
            }
            checks_.add(where, "out_of_range",
                        "must stay within " + number_text(checks_.limits().max_coordinate) + " either way, reaches [" +
                            number_text(far->x) + ", " + number_text(far->y) + "]");
            return false;
        }
        bool good = true;
        for (std::size_t i = 0; i < list.size(); ++i) {
            good = checks_.coordinates(where.index(i), list[i]) && good;
        }
        return good;
    }

    static bool fewer_than_three_distinct(const std::vector<Point>& points) {
        const Point& first = points.front();
        const auto second =
            std::find_if(points.begin(), points.end(), [&](const Point& p) { return p != first; });
        return second == points.end() || std::none_of(second, points.end(), [&](const Point& p) {
                   return p != first && p != *second;
               });
    }

    static bool in_a_line(const std::vector<Point>& points) {
        const Point& first = points.front();
        Point along{0};
        double length = 0;
        double largest = 0;
        for (const Point& p : points) {
            largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
            const double distance = std::hypot(p.x - first.x, p.y - first.y);
            if (distance > length) {
                length = distance;
                along = p - first;
            }
        }
        // Points meant to lie in a line miss it by the rounding of their coordinates.
        const double tolerance = length * (1e-12 * length + 4e-16 * largest);
        return std::all_of(points.begin(), points.end(), [&](const Point& p) {
            const Point d = p - first;
            return std::abs(d.x * along.y - d.y * along.x) <= tolerance;
        });
    }

    RangeChecks& checks_;
    const Path& where_;
    std::size_t index_;
};

std::size_t point_count(const Geometry& geometry) {
    if (const auto* polyline = std::get_if<Polyline>(&geometry)) {
        return polyline->points.size();
    }
    if (const auto* polygon = std::get_if<Polygon>(&geometry)) {
        return polygon->points.size();
    }
    return 0;
}

double texel_count(const Geometry& geometry) {
    const auto* bitmap = std::get_if<Bitmap>(&geometry);
    return bitmap && bitmap->image ? double(bitmap->image->width) * double(bitmap->image->height)
                                   : 0;
}

void validate_gradient(RangeChecks& checks, const Path& where, const Shape& shape) {
    const std::vector<EmissionStop>& stops = shape.gradient;
    if (stops.empty()) {
        return;
    }
    const auto* polyline = std::get_if<Polyline>(&shape.geometry);
    if (polyline == nullptr && !std::holds_alternative<Line>(shape.geometry)) {
        checks.add(where, "conflict", "is for lines and polylines");
    }
    if (polyline != nullptr && polyline->points.size() > checks.limits().max_gradient_points) {
        checks.add(where, "too_many",
                   "is for polylines of at most " + std::to_string(checks.limits().max_gradient_points) +
                       " points, this one has " + std::to_string(polyline->points.size()));
    }
    if (!checks.count(where, stops.size(), checks.limits().max_emission_stops, "stops")) {
        return;
    }
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const Path stop = where.index(i);
        const Path at = stop.key("at");
        checks.colour(stop.key("emission"), stops[i].emission, checks.limits().max_radiance);
        if (!checks.between(at, stops[i].at, 0, 1) || i == 0) {
            continue;
        }
        if (stops[i].at < stops[i - 1].at) {
            checks.add(at, "not_in_order",
                       "must not be less than that of the stop before, " + number_text(stops[i - 1].at) +
                           ", is " + number_text(stops[i].at));
        } else if (i >= 2 && stops[i].at == stops[i - 2].at) {
            checks.add(at, "too_many", "must not be that of a third stop (two make a step), is " +
                                           number_text(stops[i].at));
        }
    }
}

}  // namespace

void validate_shapes(RangeChecks& checks, const Path& where, const std::vector<Shape>& shapes) {
    const Limits& limits = checks.limits();
    // One problem is enough for a list that is too long: its shapes are not looked at.
    if (!checks.count(where, shapes.size(), limits.max_shapes, "shapes")) {
        return;
    }
    std::size_t points = 0;
    double texels = 0;
    for (const Shape& shape : shapes) {
        points += point_count(shape.geometry);
        texels += texel_count(shape.geometry);
    }
    if (points > limits.max_points) {
        checks.add(where, "too_many",
                   "must hold at most " + std::to_string(limits.max_points) +
                       " points in all polylines and polygons together, hold " +
                       std::to_string(points));
    }
    if (texels > limits.max_bitmap_texels) {
        checks.add(where, "too_large",
                   "must hold at most " + number_text(limits.max_bitmap_texels) +
                       " texels in all bitmaps together, hold " + number_text(texels));
    }
    std::size_t edges = 0;  // of translucent shapes
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const Path shape_path = where.index(i);
        std::visit(GeometryChecks(checks, shape_path, i), shapes[i].geometry);
        if (!std::holds_alternative<Bitmap>(shapes[i].geometry)) {
            checks.colour(shape_path.key("emission"), shapes[i].emission, limits.max_radiance);
            validate_gradient(checks, shape_path.key("emission").key("gradient"), shapes[i]);
            checks.colour(shape_path.key("albedo"), shapes[i].albedo, 1);
        }
        if (const auto& medium = shapes[i].medium) {
            const Path medium_path = shape_path.key("medium");
            checks.colour(medium_path.key("extinction"), medium->extinction, limits.max_radiance);
            checks.colour(medium_path.key("emission"), medium->emission, limits.max_radiance);
            edges += std::max<std::size_t>(point_count(shapes[i].geometry), 1);
            if (edges > limits.max_medium_edges && edges - std::max<std::size_t>(point_count(shapes[i].geometry), 1) <= limits.max_medium_edges)
                checks.add(medium_path, "too_many",
                           "must not be: all translucent shapes together may have at most " + std::to_string(limits.max_medium_edges) +
                               " edges, and this one goes beyond");
        }
    }
}

}  // namespace penumbra
