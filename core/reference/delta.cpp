// SPDX-License-Identifier: MIT
#include "core/reference/delta.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

Point direction_of(double degrees) {
    return {std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180)};
}

double spot_factor(const SpotLight& light, Point from_light) {
    // atan2 keeps narrow beams exact where a cosine has lost its digits.
    const Point axis = direction_of(light.direction_deg);
    const double angle = std::abs(std::atan2(cross(axis, from_light), dot(axis, from_light)));
    const double inner = light.inner_angle_deg * kPi / 180;
    const double outer = light.outer_angle_deg * kPi / 180;
    if (outer <= inner) return angle <= outer ? 1 : 0;
    const double ramp = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    const double held = std::clamp(ramp, 0.0, 1.0);
    return held * held;
}

}  // namespace

DeltaLights::DeltaLights(const Scene& scene, const Boundary& boundary, const Media& media)
    : lights_(scene.lights),
      boundary_(boundary),
      media_(media),
      least_distance_(0.5 * scene.canvas.pixel_size()) {}

DeltaLights::Arrival DeltaLights::arrival(const Light& light, Point p) const {
    Arrival made;
    if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
        made.direction = -direction_of(sun->direction_deg);
        made.strength = sun->irradiance;
        made.distance = std::numeric_limits<double>::infinity();
        return made;
    }
    const auto* spot = std::get_if<SpotLight>(&light);
    const Point position = spot ? spot->position : std::get<PointLight>(light).position;
    const Point way = position - p;
    made.distance = std::sqrt(length_squared(way));
    made.at_light = made.distance == 0;
    made.direction = made.at_light ? Point(1, 0) : way / made.distance;
    const Colour intensity = spot ? spot->intensity : std::get<PointLight>(light).intensity;
    made.strength = intensity / std::max(made.distance, least_distance_);
    // At the light itself no direction is off the axis.
    if (spot && !made.at_light) made.strength *= spot_factor(*spot, -way);
    return made;
}

bool DeltaLights::is_visible(const Arrival& arrival, Point p, Point forward,
                             const std::vector<Interval>& seen) const {
    if (arrival.at_light) return true;
    const double key = direction_key(forward, arrival.direction);
    auto found = std::lower_bound(seen.begin(), seen.end(), key,
                                  [](const Interval& i, double k) { return i.key_to < k; });
    if (found == seen.end()) --found;
    if (found->piece < 0) return true;
    // A light on an outline lights the outside: the piece it stands on does not block it.
    const Piece& piece = boundary_.pieces()[std::size_t(found->piece)];
    return distance_to(piece, p, arrival.direction) >= arrival.distance - 4 * boundary_.tolerance();
}

Colour DeltaLights::mean_radiance(Point p, Point forward, const std::vector<Interval>& seen) const {
    Colour sum(0);
    for (const Light& light : lights_) {
        const Arrival way = arrival(light, p);
        if (way.strength == Colour(0) || !is_visible(way, p, forward, seen)) continue;
        sum += media_.along(p, way.direction, way.distance).transmittance * way.strength / (2 * kPi);
    }
    return sum;
}

Colour DeltaLights::irradiance(Point p, Point forward, const std::vector<Interval>& seen) const {
    Colour sum(0);
    for (const Light& light : lights_) {
        const Arrival way = arrival(light, p);
        const double cosine = way.at_light ? 1 : dot(forward, way.direction);
        if (cosine <= 0 || way.strength == Colour(0) || !is_visible(way, p, forward, seen))
            continue;
        sum += way.strength * cosine;
    }
    return sum;
}

std::uint64_t DeltaLights::lit_set(Point p, Point forward,
                                   const std::vector<Interval>& seen) const {
    std::uint64_t set = 14695981039346656037ull;  // FNV-1a over one bit a light
    for (const Light& light : lights_) {
        const Arrival way = arrival(light, p);
        const bool lit = dot(forward, way.direction) > 0 && way.strength != Colour(0) &&
                         is_visible(way, p, forward, seen);
        set = (set ^ std::uint64_t(lit)) * 1099511628211ull;
    }
    return set;
}

}  // namespace penumbra::reference
