// SPDX-License-Identifier: MIT
// What a point sees: the visible boundary as intervals of direction, by an angular sweep over all
// critical angles. Exact up to rounding: within an interval the first piece hit is one and the
// same.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/reference/boundary.h"

namespace penumbra::reference {

// Directions are unit vectors; the interval turns from `from` to `to` towards growing angles.
struct Interval {
    Point from{1, 0}, to{1, 0};
    double key_from = -2, key_to = 2;  // see direction_key
    std::int32_t piece = -1;           // -1: the ray leaves the domain
};

// Grows with the angle of `d` from `forward`: -2 to 2 for -180 to 180 degrees ("diamond angle"), so
// directions are ordered without trigonometry.
double direction_key(Point forward, Point d);

// Angle of an interval, in [0, 2 pi].
double angle_of(const Interval& interval);

// Distance from `p` along the unit direction `d` to the piece's line or ellipse's near side.
double distance_to(const Piece& piece, Point p, Point d);

// One per thread; it reuses its memory.
class Sweep {
public:
    // `shining` (by piece; null: all, and what lies beyond too) tells which pieces send light.
    // Where nothing that shines can be seen, intervals may say that the ray leaves the domain
    // instead of naming a dark piece.
    explicit Sweep(const Boundary& boundary, const std::vector<char>* shining = nullptr)
        : boundary_(boundary), shining_(shining) {}

    // All round `p`, in order of direction_key(forward, .), from behind `forward` and back.
    // `height`: pieces whose line passes `p` closer than this are left out; a point that lies on
    // the boundary passes the boundary's tolerance, so that it does not shadow itself.
    // Only what lies in the half plane of `forward` matters when `half` is set; the rest may be
    // left out.
    const std::vector<Interval>& look(Point p, Point forward, double height, bool half);

private:
    struct Span {
        Point from, to;  // unit directions
        double key_from, key_to;
        double rise;               // straight: cross(a - p, b - a); arc: |p'|^2 - 1 in its frame
        Point data;                // straight: b - a; arc: p' in its frame
        double nearest, farthest;  // bounds on its distance
        std::int32_t piece;
        bool is_arc;
    };
    struct Event {
        double key;
        std::int32_t span;
        std::int32_t is_start;
    };

    void add_straight(const Piece& piece, std::int32_t index, double height);
    void add_arc(const Piece& piece, std::int32_t index, double height);
    void add_span(Span span, Point from, Point to);
    void push(const Span& span);
    void drop_hidden();
    double distance(const Span& span, Point d) const;
    bool is_nearer(const Span& entering, const Span& active) const;
    void run();

    // Equal steps of direction_key, to tell cheaply what cannot be seen.
    static constexpr int kBins = 512;

    const Boundary& boundary_;
    const std::vector<char>* shining_;
    std::array<double, kBins> far_{};  // nothing beyond this distance matters there
    Point p_{0}, forward_{1, 0};
    bool half_ = false;
    std::vector<Span> spans_;
    std::vector<Event> events_;
    std::vector<std::int32_t> active_;  // spans cut by the sweeping ray, near to far
    std::vector<Interval> intervals_;
};

}  // namespace penumbra::reference
