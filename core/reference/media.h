// SPDX-License-Identifier: MIT
// Translucent shapes: what a ray loses and gains on its way through them (Beer and Lambert), in double precision.
#pragma once

#include <vector>

#include "core/reference/boundary.h"
#include "core/reference/sky.h"
#include "core/reference/sweep.h"

namespace penumbra::reference {

class Media {
public:
    // Of `scene.media`, later ones on top. `boundary`: of the opaque shapes, which hide what of a medium lies under them.
    Media(const Scene& scene, const Boundary& boundary);

    bool empty() const { return outlines_.bodies.empty(); }

    // Per channel, the radiance gained on the way and the share of what comes from its end that arrives.
    struct Passage {
        Colour radiance{0};
        Colour transmittance{1};
    };
    // From `p` in the unit direction `d`, no farther than `end` and than the domain.
    Passage along(Point p, Point d, double end) const;

    // Integral of radiance over all directions, emission of surfaces and the sky behind the media. By adaptive quadrature between
    // the directions at which what a ray crosses changes (docs/methods/media.md).
    Colour fluence(Point p, const std::vector<Interval>& seen, const SkyIntegral& sky) const;

private:
    Colour radiance(Point p, double angle, const Interval& interval, const SkyIntegral& sky) const;
    void add_turns(Point p, std::vector<double>& angles) const;
    double exit_distance(Point p, Point d) const;

    const Boundary& boundary_;
    Outlines outlines_;
    std::vector<Medium> media_;         // by shape
    std::vector<Point> corners_;        // where outlines end or meet: directions towards them are where integrands bend
    std::vector<double> sky_angles_;    // radians: stops of the sky
};

}  // namespace penumbra::reference
