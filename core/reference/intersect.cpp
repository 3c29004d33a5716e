// SPDX-License-Identifier: MIT
#include "core/reference/intersect.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

bool on_piece(const Piece& piece, double t, double slack) {
    return piece.is_full || (t >= piece.t0 - slack && t <= piece.t1 + slack);
}

// Parameter slack that stands for `tolerance` world units along the piece.
double slack_of(const Piece& piece, double tolerance) {
    const double speed = piece.is_arc
                             ? std::sqrt(std::min(length_squared(piece.u), length_squared(piece.v)))
                             : std::sqrt(length_squared(piece.b - piece.a)) / (piece.t1 - piece.t0);
    return tolerance / speed;
}

// How far `p` lies from the piece's line or ellipse (first order for ellipses).
double distance_to_carrier(const Piece& piece, Point p) {
    if (!piece.is_arc) {
        const Point d = piece.b - piece.a;
        return std::abs(cross(d, p - piece.a)) / std::sqrt(length_squared(d));
    }
    const Point q = piece.to_frame(p);
    const double norm = std::sqrt(length_squared(q));
    if (norm == 0) return std::sqrt(std::min(length_squared(piece.u), length_squared(piece.v)));
    const Point radial = (piece.u * q.x + piece.v * q.y) / norm;  // of the point on the ellipse
    return std::abs(norm - 1) * std::sqrt(length_squared(radial));
}

// Ends of `other` that lie on `piece`.
void find_ends(const Piece& piece, const Piece& other, double tolerance, bool swapped,
               std::vector<Meeting>& out) {
    if (other.is_full) return;
    for (const bool last : {false, true}) {
        const Point p = last ? other.b : other.a;
        if (distance_to_carrier(piece, p) > tolerance) continue;
        const double t = piece.parameter_of(p);
        if (!on_piece(piece, t, slack_of(piece, tolerance))) continue;
        const double t_other = last ? other.t1 : other.t0;
        out.push_back(swapped ? Meeting{t_other, t, p} : Meeting{t, t_other, p});
    }
}

void cross_straight(const Piece& first, const Piece& second, std::vector<Meeting>& out) {
    const Point d = first.b - first.a;
    const Point e = second.b - second.a;
    const double determinant = cross(d, e);
    if (determinant == 0) return;  // parallel: their ends decide
    const double f = cross(second.a - first.a, e) / determinant;
    const double g = cross(second.a - first.a, d) / determinant;
    if (f < 0 || f > 1 || g < 0 || g > 1) return;
    out.push_back({first.t0 + (first.t1 - first.t0) * f, second.t0 + (second.t1 - second.t0) * g,
                   first.a + d * f});
}

void cross_straight_arc(const Piece& line, const Piece& arc, bool swapped,
                        std::vector<Meeting>& out) {
    const Point d = line.b - line.a;
    const Point q = arc.to_frame(line.a);
    const Point w = arc.vector_to_frame(d);
    const double a = length_squared(w);
    // From the foot of the perpendicular (in the frame): stable for long lines.
    const double foot = -dot(q, w) / a;
    const Point nearest = q + w * foot;
    const double rest = 1 - length_squared(nearest);
    if (rest <= 0) return;
    const double half = std::sqrt(rest / a);
    for (const double f : {foot - half, foot + half}) {
        if (f < 0 || f > 1) continue;
        const Point p = line.a + d * f;
        const double t_arc = arc.parameter_of(p);
        if (!on_piece(arc, t_arc, 0)) continue;
        const double t_line = line.t0 + (line.t1 - line.t0) * f;
        out.push_back(swapped ? Meeting{t_arc, t_line, p} : Meeting{t_line, t_arc, p});
    }
}

void cross_arcs(const Piece& first, const Piece& second, std::vector<Meeting>& out) {
    // The second's ellipse is |q| = 1 in its frame; along the first, q = c + u cos t + v sin t.
    const Point c = second.to_frame(first.center);
    const Point u = second.vector_to_frame(first.u);
    const Point v = second.vector_to_frame(first.v);
    const double uu = length_squared(u), vv = length_squared(v);
    TrigPolynomial f;
    f.c0 = length_squared(c) - 1 + 0.5 * (uu + vv);
    f.c1 = 2 * dot(c, u);
    f.s1 = 2 * dot(c, v);
    f.c2 = 0.5 * (uu - vv);
    f.s2 = dot(u, v);
    const double size = 1 + length_squared(c) + uu + vv;
    const double largest =
        std::max({std::abs(f.c0), std::abs(f.c1), std::abs(f.s1), std::abs(f.c2), std::abs(f.s2)});
    if (largest <= 1e-12 * size) return;  // the same ellipse: the ends decide
    for (double t : f.roots()) {
        const double middle = 0.5 * (first.t0 + first.t1);
        t += 2 * kPi * std::round((middle - t) / (2 * kPi));
        if (!on_piece(first, t, 0)) continue;
        const Point p = first.center + first.u * std::cos(t) + first.v * std::sin(t);
        const double t_second = second.parameter_of(p);
        if (on_piece(second, t_second, 0)) out.push_back({t, t_second, p});
    }
}

// A sign change in [low, high] by bisection with secant steps (Illinois).
template <class F>
double bracketed_root(const F& f, double low, double high, double f_low, double f_high) {
    for (int i = 0; i < 200 && high - low > 0; ++i) {
        double t = (low * f_high - high * f_low) / (f_high - f_low);
        if (!(t > low && t < high) || i % 3 == 2) t = 0.5 * (low + high);
        if (t <= low || t >= high) break;
        const double value = f(t);
        if (value == 0) return t;
        if ((value > 0) == (f_high > 0)) {
            high = t;
            f_high = value;
        } else {
            low = t;
            f_low = value;
        }
    }
    return 0.5 * (low + high);
}

}  // namespace

double TrigPolynomial::value(double t) const {
    const double c = std::cos(t), s = std::sin(t);
    return c0 + c1 * c + s1 * s + c2 * (c * c - s * s) + s2 * 2 * s * c;
}

double TrigPolynomial::slope(double t) const {
    const double c = std::cos(t), s = std::sin(t);
    return s1 * c - c1 * s + 2 * (s2 * (c * c - s * s) - c2 * 2 * s * c);
}

std::vector<double> TrigPolynomial::roots() const {
    // At most four roots and four extremes. Cells are narrow enough that one holds at most one
    // extreme but for near-degenerate cases; a cell with an extreme is split there, so that a
    // pair of roots between two samples is found too.
    constexpr int kCells = 96;
    std::vector<double> knots;
    double slope_before = slope(0);
    for (int i = 0; i < kCells; ++i) {
        const double low = 2 * kPi * i / kCells;
        const double high = 2 * kPi * (i + 1) / kCells;
        const double slope_after = slope(high);
        knots.push_back(low);
        if ((slope_before > 0) != (slope_after > 0)) {
            knots.push_back(bracketed_root([&](double t) { return slope(t); }, low, high,
                                           slope_before, slope_after));
        }
        slope_before = slope_after;
    }
    knots.push_back(2 * kPi);
    std::vector<double> found;
    double before = value(0);
    for (std::size_t i = 1; i < knots.size(); ++i) {
        const double after = value(knots[i]);
        if (before == 0)
            found.push_back(knots[i - 1]);
        else if (after != 0 && (before > 0) != (after > 0)) {
            found.push_back(bracketed_root([&](double t) { return value(t); }, knots[i - 1],
                                           knots[i], before, after));
        }
        before = after;
    }
    return found;
}

void find_meetings(const Piece& first, const Piece& second, double tolerance,
                   std::vector<Meeting>& out) {
    find_ends(first, second, tolerance, false, out);
    find_ends(second, first, tolerance, true, out);
    if (!first.is_arc && !second.is_arc)
        cross_straight(first, second, out);
    else if (!first.is_arc)
        cross_straight_arc(first, second, false, out);
    else if (!second.is_arc)
        cross_straight_arc(second, first, true, out);
    else
        cross_arcs(first, second, out);
}

}  // namespace penumbra::reference
