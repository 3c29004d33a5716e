// SPDX-License-Identifier: MIT
#include "core/reference/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::reference {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double into_turn(double angle) {
    const double t = angle - kTurn * std::floor(angle / kTurn);
    return t < kTurn ? t : 0;
}

}  // namespace

SkyIntegral::SkyIntegral(const Sky& sky) {
    std::vector<SkyStop> stops = sky.gradient;
    if (stops.empty()) stops.push_back({0, sky.radiance});
    for (SkyStop& stop : stops) {
        if (stop.angle_deg < 0 || stop.angle_deg > 360)
            stop.angle_deg -= 360 * std::floor(stop.angle_deg / 360);
    }
    std::stable_sort(stops.begin(), stops.end(),
                     [](const SkyStop& a, const SkyStop& b) { return a.angle_deg < b.angle_deg; });
    // From each stop to the next; the last one goes on to the first, a turn later.
    const auto add = [&](double from, double to, const Colour& start, const Colour& end) {
        if (to > from) pieces_.push_back({from, to, start, (end - start) / (to - from), Colour(0)});
    };
    const double first = stops.front().angle_deg * (kTurn / 360);
    const double last = stops.back().angle_deg * (kTurn / 360);
    const double gap = first + kTurn - last;
    const Colour a = stops.back().radiance, b = stops.front().radiance;
    const Colour at_zero = gap > 0 ? a + (b - a) * ((kTurn - last) / gap) : b;
    add(0, first, at_zero, b);
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        add(stops[i].angle_deg * (kTurn / 360), stops[i + 1].angle_deg * (kTurn / 360),
            stops[i].radiance, stops[i + 1].radiance);
    }
    add(last, kTurn, a, at_zero);
    for (Piece& piece : pieces_) {
        piece.before = total_;
        const double size = piece.to - piece.from;
        total_ += size * (piece.start + 0.5 * size * piece.slope);
    }
    is_black_ = total_ == Colour(0);
}

const SkyIntegral::Piece& SkyIntegral::piece_at(double angle) const {
    const auto after =
        std::upper_bound(pieces_.begin(), pieces_.end(), angle,
                         [](double t, const Piece& piece) { return t < piece.from; });
    return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

Colour SkyIntegral::radiance(double angle) const {
    const double t = into_turn(angle);
    const Piece& piece = piece_at(t);
    return piece.start + piece.slope * (t - piece.from);
}

Colour SkyIntegral::integral_from_zero(double angle) const {
    const Piece& piece = piece_at(angle);
    const double t = angle - piece.from;
    return piece.before + t * (piece.start + 0.5 * t * piece.slope);
}

Colour SkyIntegral::integral(double angle, double extent) const {
    const double from = into_turn(angle);
    const double to = from + extent;
    if (to <= kTurn) {
        // Within one piece without cancellation, which is the usual case.
        const Piece& piece = piece_at(from);
        if (to <= piece.to)
            return extent * (piece.start + piece.slope * (from - piece.from + 0.5 * extent));
        return integral_from_zero(to) - integral_from_zero(from);
    }
    return total_ - integral_from_zero(from) + integral_from_zero(to - kTurn);
}

Colour SkyIntegral::cosine_integral(double angle, double extent, double normal_angle) const {
    const double from = into_turn(angle);
    const double to = from + extent;
    Colour sum(0);
    for (const double turn : {0.0, kTurn}) {
        for (const Piece& piece : pieces_) {
            const double low = std::max(from, piece.from + turn);
            const double high = std::min(to, piece.to + turn);
            if (!(low < high)) continue;
            // (start + slope t) cos has the integral (start + slope t) sin + slope cos.
            const auto primitive = [&](double t) {
                const Colour value = piece.start + piece.slope * (t - piece.from - turn);
                return value * std::sin(t - normal_angle) +
                       piece.slope * std::cos(t - normal_angle);
            };
            sum += primitive(high) - primitive(low);
        }
    }
    return sum;
}

}  // namespace penumbra::reference
