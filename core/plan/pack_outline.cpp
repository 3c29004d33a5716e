// SPDX-License-Identifier: MIT
#include "core/plan/pack_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <map>
#include <set>
#include <unordered_map>

#include "core/plan/closed.h"
#include "core/plan/corners.h"
#include "core/plan/pack.h"
#include "core/plan/survey.h"
#include "core/reference/boundary.h"
#include "core/reference/sky.h"
#include "glsl/exact.h"

namespace penumbra {
namespace {

using reference::Piece;

enum class Kind { straight, disc, arc, ellipse };

bool is_round(const Piece& piece) {
    const double u = reference::length_squared(piece.u), v = reference::length_squared(piece.v);
    return std::abs(u - v) <= 1e-12 * u && std::abs(reference::dot(piece.u, piece.v)) <= 1e-12 * u;
}

Kind kind_of(const Piece& piece) {
    if (!piece.is_arc) return Kind::straight;
    if (!is_round(piece)) return Kind::ellipse;
    return piece.is_full ? Kind::disc : Kind::arc;
}

// Circles of which only arcs can be seen, but which may be taken whole: what is hidden of them lies inside shapes of the
// same light, as the round end of a stroke does. A whole circle is one entry that is cheap to ask, and hides more.
class WholeCircles {
public:
    WholeCircles() = default;
    explicit WholeCircles(const reference::Boundary& boundary) : boundary_(&boundary) {
        // Which lights meet at each corner.
        for (const Piece& piece : boundary.pieces()) {
            if (piece.is_full) continue;
            for (const Point end : {piece.a, piece.b}) {
                const auto [at, is_new] = corners_.try_emplace(corner(end), piece.material);
                if (!is_new && !same_light(at->second, piece.material)) at->second = kMixed;
            }
        }
        for (std::size_t i = 0; i < boundary.pieces().size(); ++i) {
            const Piece& piece = boundary.pieces()[i];
            if (kind_of(piece) != Kind::arc) continue;
            std::vector<std::size_t>& arcs = circles_[circle(piece)];
            arcs.push_back(i);
        }
        for (const auto& [key, arcs] : circles_) {
            // What the end of the domain cuts off is not hidden: it is not there.
            const Piece& first = boundary.pieces()[arcs.front()];
            const Point reach(std::sqrt(reference::length_squared(first.u)));
            bool whole = boundary.domain().contains(first.center - reach) && boundary.domain().contains(first.center + reach);
            const int light = first.material;
            for (const std::size_t i : arcs) {
                const Piece& piece = boundary.pieces()[i];
                whole = whole && same_light(piece.material, light) && corners_.at(corner(piece.a)) != kMixed &&
                        corners_.at(corner(piece.b)) != kMixed;
            }
            if (!whole) continue;
            firsts_.insert(arcs.front());
            for (const std::size_t i : arcs) members_.insert(i);
        }
    }

    bool is_part(std::size_t piece) const { return members_.contains(piece); }
    bool is_first(std::size_t piece) const { return firsts_.contains(piece); }

private:
    static constexpr int kMixed = -1;
    using Key = std::array<std::int64_t, 3>;

    bool same_light(int a, int b) const {
        if (a == kMixed || b == kMixed) return false;
        const auto& all = boundary_->materials();
        return all[std::size_t(a)].emission == all[std::size_t(b)].emission && all[std::size_t(a)].slope == Colour(0) && all[std::size_t(b)].slope == Colour(0);
    }
    Key corner(Point p) const { return {at(p.x), at(p.y), 0}; }
    Key circle(const Piece& piece) const {
        return {at(piece.center.x), at(piece.center.y), at(std::sqrt(reference::length_squared(piece.u)))};
    }
    // Coordinates within rounding of one another fall together, but for those on a border, which stay apart: then the arcs
    // are kept.
    std::int64_t at(double v) const { return std::llround(v / (64 * boundary_->tolerance())); }

    const reference::Boundary* boundary_ = nullptr;
    std::map<Key, int> corners_;
    std::map<Key, std::vector<std::size_t>> circles_;
    std::set<std::size_t> members_, firsts_;
};

// Cuts the pieces of a scene that reflects into elements.
class SurfaceMaker {
public:
    SurfaceMaker(const Scene& scene, const PixelFrame& frame, const reference::Boundary& boundary, bool reflecting)
        : frame_(frame), boundary_(boundary), reflecting_(reflecting) {
        double length = 0;
        for (const Piece& piece : boundary.pieces())
            if (reflecting && boundary.material_of(piece).albedo != Colour(0)) length += course_of(piece).length;
        size_ = std::max(element_size(scene.render.quality), 2 * length / kMostNodes);
    }

    void add(const Piece& piece, glm::vec4 ends, double radiance_scale) {
        const reference::Material& material = boundary_.material_of(piece);
        const SurfaceCourse course = course_of(piece);
        const bool reflects = reflecting_ && material.albedo != Colour(0);
        // Rays of other methods find light that bounced, and with it all emission, by element.
        const bool cut = reflects || (reflecting_ && material.slope != Colour(0));
        const int count = cut ? element_count(course, size_) : 1;
        made_.pieces.emplace_back(float(made_.elements), float(course.whole ? -count : count), float(course.start_angle), float(course.sweep));
        const Colour start = material.slope == Colour(0) ? material.emission : material.emission_at(piece.a);
        made_.materials.emplace_back(glm::vec3(start / radiance_scale), 0.0f);
        made_.materials.emplace_back(glm::vec3(material.slope * reference::dot(piece.b - piece.a, material.axis) / radiance_scale), 0.0f);
        made_.materials.emplace_back(glm::vec3(0.5 * material.albedo), 0.0f);
        for (int i = 0; i < count && reflects; ++i) {
            const double u = 0.5 * (element_start(i, count, course.whole) + element_start(i + 1, count, course.whole));
            const double t = piece.t0 + u * (piece.t1 - piece.t0);
            glm::dvec2 at = frame_.point(piece.at(t));
            // Between the corners as they are packed.
            if (!piece.is_arc) at = glm::dvec2(ends.x, ends.y) * (1 - u) + glm::dvec2(ends.z, ends.w) * u;
            const Point normal = reference::turned(piece.tangent(t)) / std::sqrt(reference::length_squared(piece.tangent(t)));
            // Off the surface by some units in the last place, for a surface does not shade itself.
            const double off = std::max(kOff, 8 * 6e-8 * std::max(std::abs(at.x), std::abs(at.y)));
            const glm::dvec2 place = at + off * normal;
            const auto end_of = [&](int element) {
                return frame_.point(piece.at(piece.t0 + element_start(element, count, course.whole) * (piece.t1 - piece.t0)));
            };
            made_.nodes.push_back({glm::vec4(glm::vec2(place), glm::vec2(normal)), glm::vec2(end_of(i + 1) - end_of(i)), static_cast<std::uint32_t>(made_.elements) + static_cast<std::uint32_t>(i)});
        }
        const int chords = cut ? count : element_count(course, size_);
        for (int i = 0; i < chords; ++i) {
            const auto end_of = [&](int element) {
                const double u = element_start(element, chords, course.whole);
                if (!piece.is_arc) return glm::dvec2(ends.x, ends.y) * (1 - u) + glm::dvec2(ends.z, ends.w) * u;
                return frame_.point(piece.at(piece.t0 + u * (piece.t1 - piece.t0)));
            };
            made_.chords.push_back({glm::vec4(glm::vec2(end_of(i)), glm::vec2(end_of(i + 1))),
                                    static_cast<std::uint32_t>(made_.elements) + static_cast<std::uint32_t>(cut ? i : 0)});
        }
        made_.elements += static_cast<std::size_t>(count) + 1;
    }

    Surfaces take() { return std::move(made_); }

private:
    static constexpr double kMostNodes = 400'000;
    static constexpr double kOff = 1e-3;  // px

    SurfaceCourse course_of(const Piece& piece) const {
        SurfaceCourse course;
        course.whole = piece.is_full;
        double units = 0;
        constexpr int kChords = 32;
        const int chords = piece.is_arc ? kChords : 1;
        for (int i = 0; i < chords; ++i) {
            const auto at = [&](int k) { return piece.at(piece.t0 + (piece.t1 - piece.t0) * k / chords); };
            units += std::sqrt(reference::length_squared(at(i + 1) - at(i)));
        }
        course.length = frame_.length(units);
        if (piece.is_arc) {
            // Circles are asked by the angle on screen, ellipses by that of their own frame.
            course.start_angle = piece.t0;
            if (is_round(piece)) course.start_angle += std::atan2(piece.u.y, piece.u.x);
            course.sweep = piece.t1 - piece.t0;
        }
        return course;
    }

    const PixelFrame& frame_;
    const reference::Boundary& boundary_;
    bool reflecting_ = false;
    double size_ = 1;
    Surfaces made_;
};

// Extent (world units) of the smallest light: of what is seen of each body.
double smallest_light(const reference::Boundary& boundary) {
    std::map<int, reference::Box> boxes;
    for (const Piece& piece : boundary.pieces()) {
        if (!boundary.material_of(piece).shines()) continue;
        const reference::Box box = piece.box();
        reference::Box& all = boxes[piece.body];
        all.add(box.low);
        all.add(box.high);
    }
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto& [body, box] : boxes) smallest = std::min(smallest, std::max(box.high.x - box.low.x, box.high.y - box.low.y));
    return boxes.empty() ? 0 : smallest;
}

// Extent (world units) of the smallest shape of which anything is seen: all of it, since what hides a part of it hides as much.
double smallest_body(const reference::Boundary& boundary) {
    std::map<int, reference::Box> boxes;
    for (const reference::Body& body : boundary.bodies()) {
        reference::Box& all = boxes[body.shape];
        all.add(body.box.low);
        all.add(body.box.high);
    }
    std::set<int> seen;
    for (const Piece& piece : boundary.pieces()) seen.insert(boundary.bodies()[std::size_t(piece.body)].shape);
    double smallest = std::numeric_limits<double>::infinity();
    for (const int shape : seen) {
        const reference::Box& box = boxes[shape];
        smallest = std::min(smallest, std::max(box.high.x - box.low.x, box.high.y - box.low.y));
    }
    return seen.empty() ? 0 : smallest;
}

}  // namespace

PackedOutline pack_outline(const Scene& scene, double radiance_scale, bool survey, std::size_t most_pieces, bool reflecting) {
    const reference::Boundary boundary(scene, most_pieces, false);
    PackedOutline out;
    if (!boundary.problems().empty()) {
        out.fits = false;
        return out;
    }
    const PixelFrame frame(scene.canvas);
    Corners corners(frame);
    const double scale = frame.pixels_per_unit;
    out.dark_regions = dark_regions(boundary, frame);
    const auto vec = [](glm::dvec2 a, glm::dvec2 b) { return glm::vec4(glm::vec2(a), glm::vec2(b)); };
    out.smallest_light = smallest_light(boundary) * scale;
    out.smallest_body = smallest_body(boundary) * scale;
    if (survey) {
        std::vector<char> shining;
        for (const Piece& piece : boundary.pieces()) shining.push_back(boundary.material_of(piece).shines());
        out.mean_intervals = survey_intervals(scene, boundary, reference::SkyIntegral(scene.sky).is_black() ? &shining : nullptr);
    }
    // Elements lie on what can be seen: nothing is taken whole that is not.
    const bool in_parts = reflecting || std::any_of(boundary.pieces().begin(), boundary.pieces().end(),
                                                    [&](const Piece& piece) { return boundary.material_of(piece).slope != Colour(0); });
    const WholeCircles whole = in_parts ? WholeCircles() : WholeCircles(boundary);
    SurfaceMaker surfaces(scene, frame, boundary, reflecting);
    // Kind by kind, what emits first.
    for (const Kind kind : {Kind::straight, Kind::disc, Kind::arc, Kind::ellipse}) {
        for (const bool emits : {true, false}) {
            for (std::size_t i = 0; i < boundary.pieces().size(); ++i) {
                const Piece& piece = boundary.pieces()[i];
                const reference::Material& material = boundary.material_of(piece);
                if (whole.is_part(i) && !whole.is_first(i)) continue;
                const Kind own = whole.is_part(i) ? Kind::disc : kind_of(piece);
                const bool shines = material.shines() || (reflecting && material.albedo != Colour(0));
                if (own != kind || shines != emits) continue;
                const glm::vec4 ends(piece.is_full ? glm::vec2(0) : corners.at(piece.a),
                                     piece.is_full ? glm::vec2(0) : corners.at(piece.b));
                const glm::dvec2 centre = frame.point(piece.center);
                const double reach =
                    scale * std::sqrt(std::max(reference::length_squared(piece.u), reference::length_squared(piece.v)));
                switch (kind) {
                    case Kind::straight: out.entries.push_back(ends); break;
                    case Kind::disc: out.entries.push_back(vec(centre, {reach, 0})); break;
                    case Kind::arc:
                        out.entries.push_back(vec(centre, {reach, 0}));
                        out.entries.push_back(ends);
                        break;
                    case Kind::ellipse:
                        out.entries.push_back(vec(centre, {reach, piece.is_full ? 1 : 0}));
                        out.entries.push_back(vec(piece.inverse_u / scale, piece.inverse_v / scale));
                        out.entries.push_back(ends);
                        out.entries.push_back(vec(piece.u * scale, piece.v * scale));
                        break;
                }
                out.lights_of.resize(out.entries.size(), glm::vec4(glm::vec3(material.emission / radiance_scale),
                                                                   static_cast<float>(out.pieces)));
                if (in_parts) surfaces.add(piece, ends, radiance_scale);
                ++out.pieces;
                ++out.counts[static_cast<std::size_t>(kind)];
                if (emits) ++out.lights[static_cast<std::size_t>(kind)];
            }
        }
    }
    for (const int count : out.lights) out.emitting += static_cast<std::size_t>(count);
    if (in_parts) out.surfaces = surfaces.take();
    return out;
}

std::vector<glm::vec4> sky_nodes(const Sky& sky, int nodes, double radiance_scale, int moment) {
    const reference::SkyIntegral integral(sky);
    // Which of the sky's parts between its steps each direction lies in. A single step needs a second border, at angle 0, to
    // have two parts.
    std::vector<double> steps;
    for (std::size_t i = 0; i < sky.gradient.size(); ++i) {
        const SkyStop& stop = sky.gradient[i];
        const SkyStop& next = sky.gradient[(i + 1) % sky.gradient.size()];
        const double turn = i + 1 < sky.gradient.size() ? 0 : 360;
        if (next.angle_deg + turn == stop.angle_deg && next.radiance != stop.radiance) steps.push_back(std::fmod(stop.angle_deg, 360.0));
    }
    const auto part = [&](double degrees) {
        const auto before = std::count_if(steps.begin(), steps.end(), [&](double at) { return at <= degrees; });
        return static_cast<float>(steps.size() > 1 ? before % std::ptrdiff_t(steps.size()) : before);
    };
    std::vector<glm::vec4> table;
    const double step = 2 * std::numbers::pi / nodes;
    Colour sum(0);
    for (int i = 0; i <= nodes; ++i) {
        table.push_back(glm::vec4(glm::vec3(sum / radiance_scale), 0.0f));
        table.push_back(glm::vec4(glm::vec3(integral.radiance(i * step) / radiance_scale), part(360.0 * (i % nodes) / nodes)));
        sum += moment == 0 ? integral.integral(i * step, step)
                           : integral.cosine_integral(i * step, step, moment == 1 ? 0 : 0.5 * std::numbers::pi);
    }
    return table;
}

}  // namespace penumbra
