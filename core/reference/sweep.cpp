// SPDX-License-Identifier: MIT
#include "core/reference/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::reference {

double direction_key(Point forward, Point d) {
    const double x = dot(forward, d);
    const double y = cross(forward, d);
    const double size = std::abs(x) + std::abs(y);
    if (x >= 0) return y / size;
    return y >= 0 ? 2 - y / size : -2 - y / size;
}

double angle_of(const Interval& interval) {
    const double keys = interval.key_to - interval.key_from;
    if (keys >= 4) return 2 * std::numbers::pi;
    const double angle =
        std::atan2(cross(interval.from, interval.to), dot(interval.from, interval.to));
    // More than a half turn has more than half the keys; rounding must not add a whole turn.
    if (keys > 1) return angle < 0 ? angle + 2 * std::numbers::pi : angle;
    return std::max(angle, 0.0);
}

double distance_to(const Piece& piece, Point p, Point d) {
    if (!piece.is_arc) {
        const Point e = piece.b - piece.a;
        return cross(piece.a - p, e) / cross(d, e);
    }
    const Point q = piece.to_frame(p);
    const Point w = piece.vector_to_frame(d);
    const double a = length_squared(w), b = dot(q, w), c = length_squared(q) - 1;
    return c / (-b + std::sqrt(std::max(b * b - a * c, 0.0)));
}

double Sweep::distance(const Span& span, Point d) const {
    if (!span.is_arc) return span.rise / cross(d, span.data);
    const Piece& piece = boundary_.pieces()[std::size_t(span.piece)];
    const Point w = piece.vector_to_frame(d);
    const double a = length_squared(w), b = dot(span.data, w);
    return span.rise / (-b + std::sqrt(std::max(b * b - a * span.rise, 0.0)));
}

// Pieces do not cross, so any direction that both spans hold decides. The middle of what they share
// is the safest: their ends may touch.
bool Sweep::is_nearer(const Span& entering, const Span& active) const {
    const Point end = entering.key_to < active.key_to ? entering.to : active.to;
    Point d = entering.from + end;
    const double size = length_squared(d);
    // Half a turn or so: only a piece that passes within rounding of the point.
    if (size < 1e-24)
        d = -turned(entering.from);
    else
        d /= std::sqrt(size);
    const double mine = distance(entering, d);
    const double other = distance(active, d);
    return mine < other || (mine == other && entering.piece < active.piece);
}

void Sweep::push(const Span& span) {
    if (span.key_from < span.key_to) spans_.push_back(span);
}

// Leaves out spans that lie, all along, behind others or behind all that shines. Bins make the test
// coarse but never wrong: a span hides what is farther in the bins that it covers wholly.
void Sweep::drop_hidden() {
    constexpr double kScale = kBins / 4.0;
    const auto bin = [](double key) { return std::clamp(int((key + 2) * kScale), 0, kBins - 1); };
    far_.fill(shining_ ? 0 : std::numeric_limits<double>::infinity());
    if (shining_) {
        for (const Span& span : spans_) {
            if (!(*shining_)[std::size_t(span.piece)]) continue;
            for (int i = bin(span.key_from); i <= bin(span.key_to); ++i)
                far_[std::size_t(i)] = std::max(far_[std::size_t(i)], span.farthest);
        }
    }
    for (const Span& span : spans_) {
        const int first = int(std::ceil((span.key_from + 2) * kScale));
        const int end = std::min(int((span.key_to + 2) * kScale), kBins);
        for (int i = first; i < end; ++i)
            far_[std::size_t(i)] = std::min(far_[std::size_t(i)], span.farthest);
    }
    for (std::size_t s = 0; s < spans_.size(); ++s) {
        const Span& span = spans_[s];
        bool matters = false;
        for (int i = bin(span.key_from); i <= bin(span.key_to) && !matters; ++i)
            matters = far_[std::size_t(i)] >= span.nearest;
        if (!matters) continue;
        events_.push_back({span.key_from, std::int32_t(s), 1});
        events_.push_back({span.key_to, std::int32_t(s), 0});
    }
}

void Sweep::add_span(Span span, Point from, Point to) {
    const double to_from = std::sqrt(length_squared(from));
    const double to_to = std::sqrt(length_squared(to));
    span.from = from / to_from;
    span.to = to / to_to;
    // An arc bulges towards the observer: no point of it is farther than its ends either. The
    // bounds give way to rounding.
    span.farthest = std::max(to_from, to_to) * (1 + 1e-12);
    span.nearest *= 1 - 1e-12;
    // A span is less than half a turn: with both ends behind, all of it is.
    if (half_ && dot(forward_, span.from) <= 0 && dot(forward_, span.to) <= 0) return;
    span.key_from = direction_key(forward_, span.from);
    span.key_to = direction_key(forward_, span.to);
    if (span.key_from == 2) span.key_from = -2;
    if (span.key_to == -2) span.key_to = 2;
    if (span.key_from - span.key_to > 1.9) {  // it crosses the cut behind `forward`
        Span second = span;
        span.to = -forward_;
        span.key_to = 2;
        second.from = -forward_;
        second.key_from = -2;
        push(second);
    }
    push(span);
}

void Sweep::add_straight(const Piece& piece, std::int32_t index, double height) {
    const Point a = piece.a - p_;
    const Point b = piece.b - p_;
    const Point e = piece.b - piece.a;
    const double rise = cross(a, e);
    // Seen from behind (its free side faces away) or edge on. cross(b, a) > 0 from in front.
    if (!(rise < 0) || rise * rise <= height * height * length_squared(e)) return;
    Span span{};
    span.rise = rise;
    span.data = e;
    span.piece = index;
    // The foot of the perpendicular, where it lies on the piece, else the nearer end.
    if (dot(a, e) < 0 && dot(b, e) > 0)
        span.nearest = -rise / std::sqrt(length_squared(e));
    else
        span.nearest = std::sqrt(std::min(length_squared(a), length_squared(b)));
    add_span(span, b, a);
}

void Sweep::add_arc(const Piece& piece, std::int32_t index, double height) {
    const Point q = piece.to_frame(p_);
    const double norm = length_squared(q);
    const double rise = norm - 1;
    if (rise <= 0) return;
    // To first order the distance to the ellipse is (|q| - 1) times a radius.
    if (height > 0) {
        const double reach = rise / (1 + std::sqrt(norm));
        if (reach * reach * std::max(length_squared(piece.u), length_squared(piece.v)) <=
            height * height)
            return;
    }
    // Tangent points in the frame: q / |q| turned by the angle of cosine 1 / |q| either way.
    const double side = std::sqrt(rise);
    const Point first = (q + Point(q.y, -q.x) * side) / norm;  // of smaller parameter
    const Point last = (q + Point(-q.y, q.x) * side) / norm;
    const auto towards = [&](Point e) { return piece.center + piece.u * e.x + piece.v * e.y - p_; };
    Span span{};
    span.is_arc = true;
    // No ellipse comes nearer than its longer radius lets it.
    const double reach = std::sqrt(std::max(length_squared(piece.u), length_squared(piece.v)));
    span.nearest = std::sqrt(length_squared(p_ - piece.center)) - reach;
    span.rise = rise;
    span.data = q;
    span.piece = index;
    if (piece.is_full) {
        add_span(span, towards(last), towards(first));
        return;
    }
    const bool front_a = dot(piece.e0, q) > 1;
    const bool front_b = dot(piece.e1, q) > 1;
    if (!front_a && !front_b) {
        // Wholly behind its own horizon, or the whole front lies on it.
        if (!(cross(piece.e0, q) > 0 && cross(q, piece.e1) > 0)) return;
        add_span(span, towards(last), towards(first));
    } else {
        add_span(span, front_b ? piece.b - p_ : towards(last),
                 front_a ? piece.a - p_ : towards(first));
    }
}

const std::vector<Interval>& Sweep::look(Point p, Point forward, double height, bool half) {
    p_ = p;
    forward_ = forward;
    half_ = half;
    spans_.clear();
    events_.clear();
    const std::vector<Piece>& pieces = boundary_.pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].is_arc)
            add_arc(pieces[i], std::int32_t(i), height);
        else
            add_straight(pieces[i], std::int32_t(i), height);
    }
    drop_hidden();
    run();
    return intervals_;
}

void Sweep::run() {
    // At one direction what ends goes before what starts: neighbours along an outline share it.
    std::sort(events_.begin(), events_.end(), [](const Event& x, const Event& y) {
        return x.key != y.key ? x.key < y.key : x.is_start < y.is_start;
    });
    intervals_.clear();
    active_.clear();
    Interval open;
    open.from = -forward_;
    const auto close = [&](Point at, double key, std::int32_t next) {
        open.to = at;
        open.key_to = key;
        if (open.key_to > open.key_from) intervals_.push_back(open);
        open.from = at;
        open.key_from = key;
        open.piece = next;
    };
    for (const Event& event : events_) {
        const Span& span = spans_[std::size_t(event.span)];
        if (event.is_start) {
            const auto place = std::partition_point(
                active_.begin(), active_.end(),
                [&](std::int32_t other) { return !is_nearer(span, spans_[std::size_t(other)]); });
            active_.insert(place, event.span);
        } else {
            active_.erase(std::find(active_.begin(), active_.end(), event.span));
        }
        const std::int32_t top = active_.empty() ? -1 : spans_[std::size_t(active_.front())].piece;
        if (top != open.piece) close(event.is_start ? span.from : span.to, event.key, top);
    }
    close(-forward_, 2, -1);
}

}  // namespace penumbra::reference
