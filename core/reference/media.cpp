// SPDX-License-Identifier: MIT
#include "core/reference/media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/reference/intersect.h"

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

// A part between two turns is halved until Kronrod's and Gauss's sums differ by less than this share of the larger of its
// integral and the mean of what has been found so far.
constexpr double kTolerance = 1e-7;
constexpr int kDeepest = 14;

// (1 - exp(-sigma s)) / sigma, also where sigma is nothing.
double gained(double sigma, double length) { return sigma * length < 1e-12 ? length : -std::expm1(-sigma * length) / sigma; }

// Appends the distances, in order of the piece's course, at which the ray meets it.
void meet(const Piece& piece, Point p, Point d, std::vector<double>& out) {
    if (!piece.is_arc) {
        const Point e = piece.b - piece.a;
        const double facing = cross(d, e);
        if (facing == 0) return;
        const double share = cross(piece.a - p, d) / facing;
        if (share >= 0 && share <= 1) out.push_back(cross(piece.a - p, e) / facing);
        return;
    }
    const Point q = piece.to_frame(p);
    const Point w = piece.vector_to_frame(d);
    const double a = length_squared(w), b = dot(q, w), c = length_squared(q) - 1;
    const double room = b * b - a * c;
    if (room <= 0) return;
    // The root that does not cancel first.
    const double far = -(b + std::copysign(std::sqrt(room), b));
    for (const double t : {far / a, far == 0 ? 0.0 : c / far}) {
        if (!piece.is_full) {
            const Point on = q + w * t;
            double angle = std::atan2(on.y, on.x);
            while (angle < piece.t0) angle += 2 * kPi;
            while (angle >= piece.t0 + 2 * kPi) angle -= 2 * kPi;
            if (angle > piece.t1) continue;
        }
        out.push_back(t);
    }
}

// Gauss-Kronrod, 7 and 15 points (Kronrod 1965; the table of QUADPACK).
struct Quadrature {
    Colour value{0};
    double error = 0;
};

template <class Integrand>
Quadrature kronrod(double low, double high, const Integrand& f) {
    constexpr std::array<double, 8> kNode = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                             0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                             0.586087235467691130294144691693291, 0.405845151377397166906606412076961,
                                             0.207784955007898467600689403773245, 0.0};
    constexpr std::array<double, 8> kWeight = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                               0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                               0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                               0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    constexpr std::array<double, 4> kGauss = {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                              0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    Colour whole(0), coarse(0);
    for (std::size_t i = 0; i < kNode.size(); ++i) {
        Colour both = f(middle + half * kNode[i]);
        if (i + 1 < kNode.size()) both += f(middle - half * kNode[i]);
        whole += kWeight[i] * both;
        if (i % 2 == 1) coarse += kGauss[i / 2] * both;
    }
    const Colour off = (whole - coarse) * half;
    return {whole * half, std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)})};
}

template <class Integrand>
Colour integrate(double low, double high, const Integrand& f, double allowed, int depth) {
    const Quadrature q = kronrod(low, high, f);
    const double size = std::max({std::abs(q.value.r), std::abs(q.value.g), std::abs(q.value.b)});
    if (q.error <= std::max(kTolerance * size, allowed) || depth == kDeepest) return q.value;
    const double middle = 0.5 * (low + high);
    return integrate(low, middle, f, 0.5 * allowed, depth + 1) + integrate(middle, high, f, 0.5 * allowed, depth + 1);
}

Scene of_media(const Scene& scene) {
    Scene result;
    result.canvas = scene.canvas;
    result.shapes = scene.media;
    return result;
}

}  // namespace

Media::Media(const Scene& scene, const Boundary& boundary) : boundary_(boundary) {
    if (scene.media.empty()) return;
    outlines_ = outlines_of(of_media(scene), std::numeric_limits<std::size_t>::max());
    for (const Shape& shape : scene.media) media_.push_back(*shape.medium);
    const Box domain = boundary.domain();
    const Point corner[4] = {domain.low, {domain.high.x, domain.low.y}, domain.high, {domain.low.x, domain.high.y}};
    std::vector<Piece> others = boundary.pieces();
    for (int i = 0; i < 4; ++i) {
        corners_.push_back(corner[i]);
        others.push_back(straight_piece(corner[i], corner[(i + 1) % 4]));
    }
    const std::vector<Piece>& own = outlines_.pieces;
    std::vector<Meeting> meetings;
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (!own[i].is_full) {
            corners_.push_back(own[i].a);
            corners_.push_back(own[i].b);
        }
        const Box box = own[i].box().grown(boundary.tolerance());
        for (std::size_t j = i + 1; j < own.size(); ++j)
            if (box.meets(own[j].box())) find_meetings(own[i], own[j], boundary.tolerance(), meetings);
        for (const Piece& other : others)
            if (box.meets(other.box())) find_meetings(own[i], other, boundary.tolerance(), meetings);
    }
    for (const Meeting& meeting : meetings) corners_.push_back(meeting.point);
    for (const SkyStop& stop : scene.sky.gradient) sky_angles_.push_back(stop.angle_deg * kPi / 180);
}

double Media::exit_distance(Point p, Point d) const {
    const Box& domain = boundary_.domain();
    double exit = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 2; ++axis) {
        if (d[axis] == 0) continue;
        exit = std::min(exit, ((d[axis] > 0 ? domain.high : domain.low)[axis] - p[axis]) / d[axis]);
    }
    return std::max(exit, 0.0);
}

Media::Passage Media::along(Point p, Point d, double end) const {
    Passage passage;
    if (empty()) return passage;
    end = std::min(end, exit_distance(p, d));
    std::vector<double> places;
    for (const Piece& piece : outlines_.pieces) meet(piece, p, d, places);
    std::erase_if(places, [&](double t) { return !(t > 0 && t < end); });
    places.push_back(end);
    std::sort(places.begin(), places.end());
    double before = 0;
    for (const double place : places) {
        const double length = place - before;
        const Point middle = p + d * (0.5 * (before + place));
        before = place;
        if (!(length > 0)) continue;
        const auto top = std::find_if(outlines_.bodies.rbegin(), outlines_.bodies.rend(), [&](const Body& body) { return body.contains(middle); });
        if (top == outlines_.bodies.rend()) continue;
        const Medium& medium = media_[std::size_t(top->shape)];
        for (int c = 0; c < 3; ++c) {
            passage.radiance[c] += passage.transmittance[c] * medium.emission[c] * gained(medium.extinction[c], length);
            passage.transmittance[c] *= std::exp(-medium.extinction[c] * length);
        }
    }
    return passage;
}

Colour Media::radiance(Point p, double angle, const Interval& interval, const SkyIntegral& sky) const {
    const Point d(std::cos(angle), std::sin(angle));
    double end = std::numeric_limits<double>::infinity();
    Colour behind(0);
    if (interval.piece < 0) {
        behind = sky.radiance(angle);
    } else {
        const Piece& piece = boundary_.pieces()[std::size_t(interval.piece)];
        const double distance = distance_to(piece, p, d);
        end = std::isfinite(distance) ? std::max(distance, 0.0) : 0.0;
        behind = boundary_.material_of(piece).emission_at(p + d * end);
    }
    const Passage passage = along(p, d, end);
    return passage.radiance + passage.transmittance * behind;
}

// Angles at which the sweep of a ray about `p` starts or ends to cross an outline, passes a corner or a meeting of two.
void Media::add_turns(Point p, std::vector<double>& angles) const {
    const auto towards = [&](Point at) {
        const Point way = at - p;
        if (length_squared(way) > 0) angles.push_back(std::atan2(way.y, way.x));
    };
    for (const Point corner : corners_) towards(corner);
    for (const Piece& piece : outlines_.pieces) {
        if (!piece.is_arc) continue;
        const Point q = piece.to_frame(p);
        const double norm = length_squared(q);
        if (norm <= 1) continue;
        const double side = std::sqrt(norm - 1);
        for (const double sign : {-1.0, 1.0}) {
            const Point touch = (q + Point(-q.y, q.x) * (sign * side)) / norm;
            towards(piece.center + piece.u * touch.x + piece.v * touch.y);
        }
    }
    angles.insert(angles.end(), sky_angles_.begin(), sky_angles_.end());
}

Colour Media::fluence(Point p, const std::vector<Interval>& seen, const SkyIntegral& sky) const {
    std::vector<double> turns;
    add_turns(p, turns);
    Colour sum(0);
    double done = 0;
    std::vector<double> cuts;
    for (const Interval& interval : seen) {
        const double size = angle_of(interval);
        if (!(size > 0)) continue;
        const double start = std::atan2(interval.from.y, interval.from.x);
        cuts.assign({0.0, size});
        for (const double turn : turns) {
            double at = std::fmod(turn - start, 2 * kPi);
            if (at < 0) at += 2 * kPi;
            if (at > 0 && at < size) cuts.push_back(at);
        }
        std::sort(cuts.begin(), cuts.end());
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
            const double low = cuts[i], width = cuts[i + 1] - low;
            if (width < 1e-14) continue;
            // Where a ray begins to cross a curve, the length grows as a square root: angles go as 3 x^2 - 2 x^3, which makes it
            // smooth at either end.
            const auto at = [&](double x) { return 6 * x * (1 - x) * width * radiance(p, start + low + width * x * x * (3 - 2 * x), interval, sky); };
            // What is small beside all that has been found is asked less closely.
            const double mean = std::max({sum.r, sum.g, sum.b}) / std::max(done, 1e-3);
            sum += integrate(0, 1, at, kTolerance * mean * width, 0);
            done += width;
        }
    }
    return sum;
}

}  // namespace penumbra::reference
