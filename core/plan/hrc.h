// SPDX-License-Identifier: MIT
// The lattices of holographic radiance cascades (docs/methods/hrc.md). Pure arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/ext/vector_int2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "core/scene/scene.h"

namespace penumbra {

// A point on the time/error curve of `hrc`.
struct HrcSettings {
    double cell_px = 1;     // between lattice points, along both axes
    int climb = 2;          // cells between neighbouring rays where they end: 2 is the paper's lattice, 1 a denser one
    int traced_levels = 4;  // ray pieces of levels 0 to this - 1 are traced, longer ones put together
    double blur = 0.25;     // weight of each of four neighbours beside the pixel's own of 1, where lattice points are pixels
};
HrcSettings hrc_settings(Quality quality);

// Level n of a quadrant: planes 2^n columns apart; from each point of a plane, rays to the next one.
struct HrcLevel {
    int planes = 0;
    int rays = 0;        // per point; ray k climbs climb * k - 2^n rows
    int cones = 0;       // between neighbouring rays
    int first_cone = 0;  // in the table of cones
    std::size_t pieces(int rows) const { return std::size_t(planes) * std::size_t(rays) * std::size_t(rows); }
};

// Directions within 45 degrees of one axis. Column a, row b of its lattice is the point first + a * along + b * across.
struct HrcQuadrant {
    int columns = 0;  // from where the view begins to the domain's far end
    int rows = 0;     // the whole domain
    int view_rows = 0;
    int row_border = 0;              // rows before the first one of the view
    glm::dvec2 first{0};             // px of the view
    glm::dvec2 along{0}, across{0};  // px
    std::vector<HrcLevel> levels;    // the last one's only plane of pieces spans all columns
    int top() const { return static_cast<int>(levels.size()) - 1; }
};

struct HrcPlan {
    HrcSettings settings;
    glm::ivec2 points{0};       // lattice points in the view
    glm::dvec2 first_point{0};  // px; the lattice is centred on the view
    std::vector<HrcQuadrant> quadrants;  // right, down, left, up; empty: not this method
    bool coloured = false;  // ray pieces let each channel through by itself
    int halves() const { return coloured ? 2 : 1; }  // of a texture of ray pieces: what they meet, then what they let through
    bool active() const { return !quadrants.empty(); }
    bool aligned() const { return settings.cell_px == 1.0; }  // each pixel's centre is a lattice point
};

HrcPlan plan_hrc(glm::ivec2 canvas, double margin_px, const HrcSettings& settings);

// Angle between rays i and i + 1 of level n, radians. Over a level they add up to a quarter turn.
double hrc_cone_angle(int level, int climb, int cone);

// What the textures of the largest quadrant and of the sum take, `texel` bytes a ray piece and a fluence.
std::size_t hrc_bytes(const HrcPlan& plan, std::size_t texel);

// For each level of each quadrant and each of its cones: the sky's radiance integrated over the cone, and its angle.
std::vector<glm::vec4> hrc_cones(const HrcPlan& plan, const Sky& sky, double radiance_scale);

}  // namespace penumbra
