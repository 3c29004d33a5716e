// SPDX-License-Identifier: MIT
#include "core/plan/sky.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

// The gradient unrolled over two turns, so that a sector never wraps: stops sorted by angle, in [0, 720].
std::vector<SkyStop> unrolled(const Sky& sky) {
    std::vector<SkyStop> stops;
    for (int turn = -1; turn <= 2; ++turn)
        for (const SkyStop& stop : sky.gradient) stops.push_back({stop.angle_deg + 360.0 * turn, stop.radiance});
    return stops;
}

Colour between(const SkyStop& a, const SkyStop& b, double angle) {
    const double width = b.angle_deg - a.angle_deg;
    if (width <= 0) return b.radiance;
    return a.radiance + (b.radiance - a.radiance) * ((angle - a.angle_deg) / width);
}

Colour integral(const std::vector<SkyStop>& stops, double from, double to) {
    Colour sum{0};
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        const double lo = std::max(from, stops[i].angle_deg);
        const double hi = std::min(to, stops[i + 1].angle_deg);
        if (hi <= lo) continue;
        // Linear between stops: the trapezoid is exact.
        sum += 0.5 * (hi - lo) * (between(stops[i], stops[i + 1], lo) + between(stops[i], stops[i + 1], hi));
    }
    return sum;
}

}  // namespace

Colour sky_radiance(const Sky& sky, double angle_deg) {
    if (sky.gradient.empty()) return sky.radiance;
    const double angle = angle_deg - 360.0 * std::floor(angle_deg / 360.0);
    const std::vector<SkyStop> stops = unrolled(sky);
    for (std::size_t i = 0; i + 1 < stops.size(); ++i)
        if (stops[i].angle_deg <= angle && angle < stops[i + 1].angle_deg) return between(stops[i], stops[i + 1], angle);
    return stops.front().radiance;
}

Colour sky_mean(const Sky& sky, double from_deg, double to_deg) {
    if (sky.gradient.empty()) return sky.radiance;
    const double turn = 360.0 * std::floor(from_deg / 360.0);
    return integral(unrolled(sky), from_deg - turn, to_deg - turn) / (to_deg - from_deg);
}

std::vector<Colour> sky_sectors(const Sky& sky, int sectors) {
    std::vector<Colour> result(static_cast<std::size_t>(sectors), sky.radiance);
    if (sky.gradient.empty()) return result;
    const std::vector<SkyStop> stops = unrolled(sky);
    const double width = 360.0 / sectors;
    std::size_t at = 0;
    for (int k = 0; k < sectors; ++k) {
        const double from = k * width;
        const double to = from + width;
        while (at + 1 < stops.size() && stops[at + 1].angle_deg <= from) ++at;
        Colour sum{0};
        for (std::size_t i = at; i + 1 < stops.size() && stops[i].angle_deg < to; ++i) {
            const double lo = std::max(from, stops[i].angle_deg);
            const double hi = std::min(to, stops[i + 1].angle_deg);
            if (hi > lo)
                sum += 0.5 * (hi - lo) * (between(stops[i], stops[i + 1], lo) + between(stops[i], stops[i + 1], hi));
        }
        result[static_cast<std::size_t>(k)] = sum / width;
    }
    return result;
}

double brightest(const Sky& sky) {
    double peak = 0;
    const auto take = [&](const Colour& c) { peak = std::max({peak, c.r, c.g, c.b}); };
    if (sky.gradient.empty()) take(sky.radiance);
    for (const SkyStop& stop : sky.gradient) take(stop.radiance);
    return peak;
}

}  // namespace penumbra
