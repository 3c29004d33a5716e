// SPDX-License-Identifier: MIT
// Point, spot and directional lights, with exact visibility from a finished sweep.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/floor.h"
#include "core/reference/media.h"
#include "core/reference/sweep.h"

namespace penumbra::reference {

class DeltaLights {
public:
    // `pixel_size` in world units: distances count as at least half a pixel.
    DeltaLights(const Scene& scene, const Boundary& boundary, const Media& media);

    bool empty() const { return lights_.empty(); }
    // What they add to the mean radiance at `p`, given all that `p` sees.
    Colour mean_radiance(Point p, Point forward, const std::vector<Interval>& seen) const;
    // What a floor sends up of them.
    Colour on_floor(const Floor& floor, const FloorPlace& place, Point p, Point forward, const std::vector<Interval>& seen) const;
    // The irradiance at a boundary point with outward normal `forward`.
    Colour irradiance(Point p, Point forward, const std::vector<Interval>& seen) const;
    // A number that tells which lights reach the boundary point (equal sets, equal numbers).
    std::uint64_t lit_set(Point p, Point forward, const std::vector<Interval>& seen) const;

private:
    struct Arrival {
        Point direction{0};  // towards the light, a unit vector (any, where `at_light`)
        bool at_light = false;
        Colour strength{0};   // flatland's irradiance across the beam, shadows left out
        Colour on_floor{0};   // what it adds to the mean radiance
        // Of lights above the canvas: the illuminance across the beam, and the sine of its elevation; else 0.
        Colour across{0};
        double up = 0;
        double distance = 0;  // infinite for directional lights
    };
    Arrival arrival(const Light& light, Point p) const;
    bool is_visible(const Arrival& arrival, Point p, Point forward,
                    const std::vector<Interval>& seen) const;

    const std::vector<Light>& lights_;
    const Boundary& boundary_;
    const Media& media_;
    double least_distance_;
};

}  // namespace penumbra::reference
