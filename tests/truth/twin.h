// SPDX-License-Identifier: MIT
// A second, independent account of light in flatland: random rays against shapes taken as intervals
// along the ray. Shares nothing with core/reference: no outlines, no critical angles, no membership
// tests of its own kind.
#pragma once

#include <random>

#include "core/scene/scene.h"

namespace penumbra::truth {

struct TwinHit {
    double distance = 0;
    bool is_sky = true;
    Colour emission{0};
    Colour albedo{0};
    Point normal{0};
};

class Twin {
public:
    explicit Twin(const Scene& scene) : scene_(scene) {}

    bool is_solid(Point p) const;
    // The first boundary point inside the domain on the ray; p must be free.
    TwinHit hit(Point p, Point direction) const;
    Colour sky(Point direction) const;
    // One random sample of the radiance that arrives at p from `direction`.
    Colour path(Point p, Point direction, int bounces, std::mt19937_64& random) const;
    // Delta lights' irradiance at a surface point with normal n.
    Colour lights_on(Point p, Point n) const;

private:
    const Scene& scene_;
};

// Shapes of all types at random, overlapping each other and the border of the domain.
Scene random_scene(unsigned seed, int shapes);

}  // namespace penumbra::truth
