// SPDX-License-Identifier: MIT
#include "core/reference/delta.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/scene/photometry.h"

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

Point direction_of(double degrees) {
    return {std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180)};
}

// atan2 keeps narrow beams exact where a cosine has lost its digits.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

DeltaLights::DeltaLights(const Scene& scene, const Boundary& boundary, const Media& media)
    : lights_(scene.lights),
      boundary_(boundary),
      media_(media),
      least_distance_(0.5 * scene.canvas.pixel_size()) {}

DeltaLights::Arrival DeltaLights::arrival(const Light& light, Point p) const {
    Arrival made;
    // Of the world above the canvas: the floor has the illuminance E and shines with E / pi; a wall that has it shines, in flatland,
    // with half of 2 E / pi.
    const auto raise = [&](const Colour& across, double up, double level) {
        made.on_floor = across * up / kPi;
        made.strength = across * level * 2.0 / kPi;
        made.across = across;
        made.up = up;
    };
    if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
        made.direction = -direction_of(sun->direction_deg);
        made.distance = std::numeric_limits<double>::infinity();
        made.strength = sun->irradiance;
        made.on_floor = sun->irradiance / (2 * kPi);
        if (sun->elevation_deg) {
            const double elevation = *sun->elevation_deg * kRadiansPerDegree;
            raise(sun->irradiance, std::sin(elevation), std::cos(elevation));
        }
        return made;
    }
    const auto* spot = std::get_if<SpotLight>(&light);
    const auto* point = std::get_if<PointLight>(&light);
    const Point position = spot ? spot->position : point->position;
    const Point way = position - p;
    made.distance = std::sqrt(length_squared(way));
    made.at_light = made.distance == 0;
    made.direction = made.at_light ? Point(1, 0) : way / made.distance;
    if ((spot ? spot->unit : point->unit) != LightUnit::radiant) {
        const double height = spot ? spot->height : point->height;
        const glm::dvec3 from_light(-way, -height);
        const double squared = glm::dot(from_light, from_light);
        const double distance = std::sqrt(squared);
        Colour candela = spot ? candela_of(*spot) : candela_of(*point);
        if (spot) {
            const double tilt = spot->tilt_deg * kRadiansPerDegree;
            const Point level = direction_of(spot->direction_deg) * std::cos(tilt);
            candela *= spot_share(*spot, angle_between({level, -std::sin(tilt)}, from_light));
        }
        raise(candela / squared, height / distance, made.distance / distance);
        return made;
    }
    made.strength = (spot ? spot->intensity : point->intensity) / std::max(made.distance, least_distance_);
    // At the light itself no direction is off the axis.
    if (spot && !made.at_light)
        made.strength *= spot_share(*spot, angle_between({direction_of(spot->direction_deg), 0}, {-way, 0}));
    made.on_floor = made.strength / (2 * kPi);
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
        if (way.on_floor == Colour(0) || !is_visible(way, p, forward, seen)) continue;
        sum += media_.along(p, way.direction, way.distance).transmittance * way.on_floor;
    }
    return sum;
}

Colour DeltaLights::on_floor(const Floor& floor, const FloorPlace& place, Point p, Point forward,
                             const std::vector<Interval>& seen) const {
    Colour sum(0);
    for (const Light& light : lights_) {
        const Arrival way = arrival(light, p);
        if (way.on_floor == Colour(0) || !is_visible(way, p, forward, seen)) continue;
        const Colour through = media_.along(p, way.direction, way.distance).transmittance;
        if (way.up > 0) {
            const double level = std::sqrt(std::max(1 - way.up * way.up, 0.0));
            sum += through * floor.lit_by_beam(place, {way.direction * level, way.up}, way.across);
        } else {
            const Point d = way.at_light ? Point(0) : way.direction;
            sum += through * floor.lit_by(place, {way.on_floor, way.on_floor * d.x, way.on_floor * d.y});
        }
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
