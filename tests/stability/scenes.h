// SPDX-License-Identifier: MIT
// Scenes that several laws are tried on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace penumbra::test {

// A move of the plane that keeps circles round.
struct Motion {
    double scale = 1;
    double turned_deg = 0;
    bool mirrored = false;  // x becomes -x, before the turn
    Point by{0};
    Point centre{0};        // of turn, scale and mirror

    Point operator()(Point p) const;
    double angle(double degrees) const { return (mirrored ? 180 - degrees : degrees) + turned_deg; }
};
Geometry moved(const Geometry& geometry, const Motion& motion);  // not for bitmaps
std::vector<Shape> moved(const std::vector<Shape>& shapes, const Motion& motion);

// Two lamps, walls of every type but bitmap, within `unit` of `centre`.
std::vector<Shape> lamps_and_walls(Point centre, double unit);

// A seeded scene. Mild: shapes of some pixels, light of one order. Wild: everything that the format allows, at its extremes.
Scene mild_scene(std::uint64_t seed);
Scene wild_scene(std::uint64_t seed);

// The smallest scene, of those reached by leaving out and rounding, in which `fails` still says what is wrong.
Scene shrunk(Scene scene, const std::function<std::string(const Scene&)>& fails);

}  // namespace penumbra::test
