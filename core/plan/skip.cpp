// SPDX-License-Identifier: MIT
#include "core/plan/skip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/plan/pack.h"
#include "core/plan/saving.h"
#include "core/plan/sky.h"

namespace penumbra {
namespace {

using glm::dvec2;

// What single precision loses of coordinates of this size, twice over: the shape below must be farther than the one above in
// the shader's arithmetic as well.
constexpr double kRounding = 2e-5;
constexpr double kLeastRounding = 1e-3;
// The shader's distance to an ellipse loses more (core/plan/shape_bounds.cpp).
constexpr double kEllipseRounding = 4e-3;

// Outlines of more points than this are not asked whether they cover others: it would cost more than it saves.
constexpr std::size_t kMostCoverPoints = 64;
// Of the shapes over a place, this many are asked whether they cover one below.
constexpr int kMostCovers = 64;
// And so many entries of such shapes are listed in all.
constexpr std::size_t kMostListed = std::size_t(1) << 18;

constexpr double kTurn = std::numbers::pi / 180.0;

struct Box {
    dvec2 low{1e300};
    dvec2 high{-1e300};
    void add(dvec2 p, double r) {
        low = glm::min(low, p - r);
        high = glm::max(high, p + r);
    }
    bool holds(const Box& o) const { return low.x <= o.low.x && low.y <= o.low.y && o.high.x <= high.x && o.high.y <= high.y; }
    bool meets(const Box& o) const { return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y; }
    Box grown(double by) const { return {low - by, high + by}; }
};

// A shape inside the convex hull of discs of one radius, in pixels of the view.
struct Hull {
    std::vector<dvec2> points;
    double radius = 0;
    Box box;
    double rounding = 0;

    void close(double more) {
        for (const dvec2 p : points) box.add(p, radius);
        rounding = kLeastRounding + kRounding * std::max(glm::length(box.low), glm::length(box.high)) + more;
    }
};

class Hulls {
public:
    explicit Hulls(const Canvas& canvas) : frame_(canvas) {}

    Hull of(const Shape& shape) const {
        Hull hull;
        const double more = std::visit([&](const auto& g) { return add(g, hull); }, shape.geometry);
        hull.close(more);
        return hull;
    }

    // A lower bound on how deep the disc lies inside the shape; negative where that is not known.
    double depth(const Geometry& geometry, dvec2 p, double radius) const {
        return std::visit([&](const auto& g) { return depth_in(g, p); }, geometry) - radius;
    }

    // Whether the hull lies inside the shape, deeper than both lose by rounding.
    bool covers(const Shape& above, const Hull& cover, const Hull& below) const {
        if (const auto* line = std::get_if<Polyline>(&above.geometry)) {
            if (line->points.size() > kMostCoverPoints) return false;
            // Each of its strokes is convex.
            const std::size_t count = line->points.size();
            for (std::size_t i = 0; i + (line->closed ? 0 : 1) < count; ++i) {
                const Geometry stroke = Line{line->points[i], line->points[(i + 1) % count], line->width};
                if (all_inside(stroke, cover, below)) return true;
            }
            return false;
        }
        if (const auto* polygon = std::get_if<Polygon>(&above.geometry)) {
            // It need not be convex: the disc around the hull must be inside.
            if (polygon->points.size() > kMostCoverPoints) return false;
            const dvec2 middle = 0.5 * (below.box.low + below.box.high);
            double reach = 0;
            for (const dvec2 q : below.points) reach = std::max(reach, glm::length(q - middle));
            return depth(above.geometry, middle, reach + below.radius) > cover.rounding + below.rounding;
        }
        if (std::holds_alternative<Bitmap>(above.geometry)) return false;
        return all_inside(above.geometry, cover, below);
    }

private:
    bool all_inside(const Geometry& above, const Hull& cover, const Hull& below) const {
        return std::all_of(below.points.begin(), below.points.end(),
                           [&](dvec2 p) { return depth(above, p, below.radius) > cover.rounding + below.rounding; });
    }

    void corners(Hull& hull, dvec2 center, dvec2 half, double rotation_deg) const {
        const dvec2 axis(std::cos(rotation_deg * kTurn), std::sin(rotation_deg * kTurn));
        const dvec2 u = axis * half.x;
        const dvec2 v = dvec2(-axis.y, axis.x) * half.y;
        for (const dvec2 q : {u + v, u - v, v - u, -u - v}) hull.points.push_back(center + q);
    }
    double add(const Circle& g, Hull& hull) const {
        hull.points = {frame_.point(g.center)};
        hull.radius = frame_.length(g.radius);
        return 0;
    }
    double add(const Ellipse& g, Hull& hull) const {
        const dvec2 half = g.radii * frame_.pixels_per_unit;
        corners(hull, frame_.point(g.center), half, g.rotation_deg);
        return kEllipseRounding * std::max(half.x, half.y);
    }
    double add(const Rect& g, Hull& hull) const {
        corners(hull, frame_.point(g.center), 0.5 * g.size * frame_.pixels_per_unit, g.rotation_deg);
        return 0;
    }
    double add(const Line& g, Hull& hull) const {
        hull.points = {frame_.point(g.from), frame_.point(g.to)};
        hull.radius = 0.5 * frame_.length(g.width);
        return 0;
    }
    double add(const Polyline& g, Hull& hull) const {
        for (const Point p : g.points) hull.points.push_back(frame_.point(p));
        hull.radius = 0.5 * frame_.length(g.width);
        return 0;
    }
    double add(const Polygon& g, Hull& hull) const {
        for (const Point p : g.points) hull.points.push_back(frame_.point(p));
        return 0;
    }
    double add(const Bitmap& g, Hull& hull) const {
        const dvec2 from = frame_.point(g.position);
        const dvec2 size = g.size * frame_.pixels_per_unit;
        for (const dvec2 share : {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1), dvec2(1, 1)}) hull.points.push_back(from + share * size);
        return 2.0;  // its distance is one to pixels' centres
    }

    double depth_in(const Circle& g, dvec2 p) const { return frame_.length(g.radius) - glm::length(p - frame_.point(g.center)); }
    double depth_in(const Ellipse& g, dvec2 p) const {
        const dvec2 r = g.radii * frame_.pixels_per_unit;
        const double share = glm::length(into(p - frame_.point(g.center), g.rotation_deg) / r);
        return (1 - share) * std::min(r.x, r.y);
    }
    double depth_in(const Rect& g, dvec2 p) const {
        const double corner = frame_.length(g.corner_radius);
        const dvec2 q = glm::abs(into(p - frame_.point(g.center), g.rotation_deg)) - 0.5 * g.size * frame_.pixels_per_unit + corner;
        return corner - glm::length(glm::max(q, dvec2(0))) - std::min(std::max(q.x, q.y), 0.0);
    }
    double depth_in(const Line& g, dvec2 p) const {
        return 0.5 * frame_.length(g.width) - segment(p, frame_.point(g.from), frame_.point(g.to));
    }
    double depth_in(const Polyline&, dvec2) const { return -1; }
    double depth_in(const Polygon& g, dvec2 p) const {
        bool odd = false;
        double nearest = 1e300;
        for_each_edge(g, [&](Point from, Point to) {
            const dvec2 a = frame_.point(from);
            const dvec2 b = frame_.point(to);
            nearest = std::min(nearest, segment(p, a, b));
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) odd = !odd;
        });
        return odd ? nearest : -nearest;
    }
    double depth_in(const Bitmap&, dvec2) const { return -1; }

    static dvec2 into(dvec2 d, double rotation_deg) {
        const double c = std::cos(rotation_deg * kTurn), s = std::sin(rotation_deg * kTurn);
        return {c * d.x + s * d.y, c * d.y - s * d.x};
    }
    static double segment(dvec2 p, dvec2 a, dvec2 b) {
        const dvec2 along = b - a;
        const double squared = glm::dot(along, along);
        const double h = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
        return glm::length(p - a - along * h);
    }

    PixelFrame frame_;
};

Box domain_of(const Canvas& canvas) {
    const GridPlan grid = plan_grid(canvas);
    return {{grid.domain.x0, grid.domain.y0}, {grid.domain.x1, grid.domain.y1}};
}

// Whether the shape surely stays farther than `beyond` outside the box.
bool is_outside(const Hull& hull, const Box& box, double beyond) {
    if (!box.grown(beyond + hull.rounding).meets(hull.box)) return true;
    if (hull.points.size() != 1) return false;
    const dvec2 p = hull.points.front();
    return glm::length(p - glm::clamp(p, box.low, box.high)) > hull.radius + beyond + hull.rounding;
}

bool has_solid_texel(const Bitmap& bitmap) {
    const std::vector<std::uint8_t>& rgba = bitmap.image->rgba;
    const double least = std::ceil(bitmap.solid_above * 255.0 - 1e-9);
    for (std::size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] >= least) return true;
    return false;
}

// Which shapes lie above a place of the domain: squares of it, with the later shapes first.
class Covers {
public:
    Covers(const std::vector<Hull>& hulls, const std::vector<char>& gone, const Box& domain) : domain_(domain) {
        side_ = std::clamp(static_cast<int>(std::sqrt(double(hulls.size()))), 1, 64);
        cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
        std::size_t listed = 0;
        for (std::size_t i = hulls.size(); i-- > 0 && listed < kMostListed;) {
            if (gone[i] != 0) continue;
            const glm::ivec2 from = cell(hulls[i].box.low);
            const glm::ivec2 to = cell(hulls[i].box.high);
            for (int y = from.y; y <= to.y; ++y)
                for (int x = from.x; x <= to.x; ++x, ++listed) at({x, y}).push_back(static_cast<int>(i));
        }
    }

    // The shapes over the middle of this one: a cover of all of it is among them.
    const std::vector<int>& over(const Hull& hull) { return at(cell(0.5 * (hull.box.low + hull.box.high))); }

private:
    glm::ivec2 cell(dvec2 p) const {
        const dvec2 share = (p - domain_.low) / (domain_.high - domain_.low) * double(side_);
        return glm::ivec2(glm::clamp(share, dvec2(0), dvec2(side_ - 1)));
    }
    std::vector<int>& at(glm::ivec2 c) { return cells_[static_cast<std::size_t>(c.y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(c.x)]; }

    Box domain_;
    int side_ = 1;
    std::vector<std::vector<int>> cells_;
};

}  // namespace

std::optional<Scene> without_unseen_shapes(const Scene& scene, std::vector<SkippedWork>& skipped) {
    if (!saves(scene.render, Saving::shapes) || scene.shapes.empty()) return std::nullopt;
    const Box domain = domain_of(scene.canvas);
    const Hulls hulls(scene.canvas);
    const std::size_t count = scene.shapes.size();
    std::vector<Hull> all;
    all.reserve(count);
    for (const Shape& shape : scene.shapes) all.push_back(hulls.of(shape));
    std::vector<char> gone(count, 0);
    std::size_t outside = 0, covered = 0, clear = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto* bitmap = std::get_if<Bitmap>(&scene.shapes[i].geometry);
        if (is_outside(all[i], domain, kKeptBeyondDomain))
            gone[i] = 1, ++outside;
        else if (bitmap != nullptr && !has_solid_texel(*bitmap))
            gone[i] = 1, ++clear;
    }
    if (count > 1) {
        Covers covers(all, gone, domain);
        for (std::size_t i = 0; i + 1 < count; ++i) {
            if (gone[i] != 0) continue;
            int asked = 0;
            for (const int above : covers.over(all[i])) {
                const auto j = static_cast<std::size_t>(above);
                if (j <= i || asked == kMostCovers) break;
                if (!all[j].box.holds(all[i].box)) continue;
                ++asked;
                if (!hulls.covers(scene.shapes[j], all[j], all[i])) continue;
                gone[i] = 1;
                ++covered;
                break;
            }
        }
    }
    if (outside + covered + clear == 0) return std::nullopt;
    Scene lean;
    lean.canvas = scene.canvas;
    lean.sky = scene.sky;
    lean.lights = scene.lights;
    lean.render = scene.render;
    lean.output = scene.output;
    lean.media = scene.media;
    for (std::size_t i = 0; i < count; ++i)
        if (gone[i] == 0) lean.shapes.push_back(scene.shapes[i]);
    const auto leave_out = [&](std::size_t shapes, const char* why) {
        if (shapes > 0) skipped.push_back({"shapes", why, double(shapes)});
    };
    leave_out(outside, "they lie outside the domain");
    leave_out(covered, "a later shape covers all of them");
    leave_out(clear, "no texel of them is solid");
    return lean;
}

bool shines(const Shape& shape) {
    const auto* bitmap = std::get_if<Bitmap>(&shape.geometry);
    if (bitmap == nullptr)
        return shape.emission != Colour(0) ||
               std::any_of(shape.gradient.begin(), shape.gradient.end(), [](const EmissionStop& stop) { return stop.emission != Colour(0); });
    if (bitmap->as_albedo || bitmap->emission_scale <= 0) return false;
    const std::vector<std::uint8_t>& rgba = bitmap->image->rgba;
    const double least = std::ceil(bitmap->solid_above * 255.0 - 1e-9);
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
        if (rgba[i + 3] >= least && (rgba[i] | rgba[i + 1] | rgba[i + 2]) != 0) return true;
    return false;
}

std::optional<ConstantLight> constant_light(const Scene& scene) {
    if (!saves(scene.render, Saving::constant) || !scene.canvas.floor.is_plain() || !scene.media.empty()) return std::nullopt;
    const auto bright = [](const Light& light) {
        return std::visit(
            [](const auto& l) {
                if constexpr (requires { l.intensity; })
                    return l.intensity != Colour(0);
                else
                    return l.irradiance != Colour(0);
            },
            light);
    };
    if (std::any_of(scene.lights.begin(), scene.lights.end(), bright)) return std::nullopt;
    const Box domain = domain_of(scene.canvas);
    const Hulls hulls(scene.canvas);
    const auto inside = [&](const Shape& shape) { return !is_outside(hulls.of(shape), domain, 0); };
    if (brightest(scene.sky) <= 0) {
        if (std::any_of(scene.shapes.begin(), scene.shapes.end(), [&](const Shape& s) { return shines(s) && inside(s); })) return std::nullopt;
        return ConstantLight{Colour(0), "nothing emits light: every pixel is black"};
    }
    if (std::any_of(scene.shapes.begin(), scene.shapes.end(), inside)) return std::nullopt;
    return ConstantLight{sky_mean(scene.sky, 0, 360), "there is only the sky: every pixel sees all of it"};
}

bool reflects(const Shape& shape) {
    const auto* bitmap = std::get_if<Bitmap>(&shape.geometry);
    return bitmap != nullptr ? bitmap->as_albedo && bitmap->emission_scale > 0 : shape.albedo != Colour(0);
}

Extent extent_of_shapes(const Scene& scene, bool only_shining, bool reflecting) {
    const Box domain = domain_of(scene.canvas);
    const Hulls hulls(scene.canvas);
    Extent extent;
    for (const Shape& shape : scene.shapes) {
        if (only_shining && !shines(shape) && !(reflecting && reflects(shape))) continue;
        const Hull hull = hulls.of(shape);
        const Box box = hull.box.grown(hull.rounding);
        if (!box.meets(domain)) continue;
        const dvec2 low = glm::max(box.low, domain.low), high = glm::min(box.high, domain.high);
        extent.x0 = std::min(extent.x0, low.x);
        extent.y0 = std::min(extent.y0, low.y);
        extent.x1 = std::max(extent.x1, high.x);
        extent.y1 = std::max(extent.y1, high.y);
    }
    return extent;
}

}  // namespace penumbra
