// SPDX-License-Identifier: MIT
// Scene and device limits in; which passes run, at what size, and what is left out. Pure arithmetic.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/ext/vector_int2.hpp>
#include <glm/vec2.hpp>

#include "core/plan/device_limits.h"
#include "core/plan/delta.h"
#include "core/plan/exact_plan.h"
#include "core/plan/hrc.h"
#include "core/plan/look.h"
#include "core/plan/skip.h"
#include "core/render_stats.h"
#include "core/scene/scene.h"

namespace penumbra {

// A box in pixels of the view: (0, 0) is the view's top left corner.
struct PixelBox {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// A part of the canvas, in pixels.
struct PixelArea {
    glm::ivec2 first{0};
    glm::ivec2 size{0};
    glm::ivec2 end() const { return first + size; }
};

// The grid of the distance field: the view and its margin, in whole pixels.
struct GridPlan {
    glm::ivec2 size{0};
    glm::ivec2 border{0};  // grid pixels left of and above the view
    PixelBox domain;       // exact, the grid rounds outwards
    double diagonal_px = 0;
};

// Base-4 radiance cascades (docs/methods/rc.md): cascade c has `groups` times four directions per probe.
struct CascadePlan {
    int level = 0;
    glm::ivec2 probes{0};
    glm::ivec2 tiles{0};         // direction groups along x and y of the texture
    glm::ivec2 texture{0};       // probes * tiles
    double spacing = 0;          // px
    glm::dvec2 first_probe{0};   // centre, px; the probe grid is centred on the view
    double start = 0, end = 0;   // interval along the ray, px
    int sky_first = 0;           // first of its directions in the sky table
    int directions() const { return 4 * tiles.x * tiles.y; }
};

// A run of shapes whose edges one dispatch of the distance pass can walk.
struct ShapeSlice {
    int first = 0;
    int end = 0;
};

// Iterations that one dispatch of the distance pass may spend: half of what Mesa 22 allows an invocation, since a
// loop's last test may count as well.
constexpr std::size_t kIterationsPerSlice = 30000;

// Loop iterations of the distance to a shape of this type (glsl/scene_records.h).
std::size_t distance_iterations(int type, std::size_t edges);

// Scenes of fewer shapes are not worth lists, where all distances are asked for.
constexpr std::size_t kFewestListedShapes = 2;

// Distances are what they are, however far.
constexpr double kUnlimitedReach = std::numeric_limits<double>::infinity();

// Brute force: `rays` stratified rays a pixel, a few per dispatch, since Mesa before 25 ends loops.
struct ReferencePlan {
    int rays = 0;  // 0: not this method
    int rays_per_dispatch = 0;
    std::size_t tests_per_ray = 1;  // loop iterations of one ray, at most
};

// What programs must be made for. Mesa 22 runs both sides of every branch, so that each kind that a scene has not costs.
struct ProgramNeeds {
    bool general = true;  // for anything
    bool ellipses = true;
    bool outlines = true;  // polylines and polygons
    bool bitmaps = true;
    bool gradients = true;  // of emission, along strokes
    bool surfaces = false;  // that shine with light that bounced, as sampled rays meet them
    bool media = false;     // translucent shapes
    bool steps = false;     // a view counts them
};

// A floor that is more than an albedo.
struct FloorPlan {
    bool used = false;
    bool relief = false;  // it matters where light comes from
    bool gloss = false;
};

struct Plan {
    std::string method;
    std::string method_reason;
    Look look;                          // of a debug view
    glm::ivec2 canvas{0};
    PixelArea shown;                    // the part of the canvas that becomes the picture
    PixelArea lit;                      // the pixels whose light is worked out: those shown and what their edges mix with
    GridPlan grid;
    int first_distance_row = 0;         // of the grid: distances are found from here
    int end_distance_row = 0;           // to here
    ProgramNeeds needs;
    std::optional<Colour> constant;     // mean radiance of every pixel: no pass runs but the picture's
    std::vector<ShapeSlice> shape_slices;
    bool list_shapes = false;           // per tile of the grid: each pixel asks its tile's shapes only
    double distance_reach_px = kUnlimitedReach;  // the field is true up to here, on both sides of an outline; beyond it says "no nearer than this"
    std::vector<int> jump_steps;        // of jump flooding, empty without bitmaps and where they matter only nearby
    bool near_bitmaps = false;          // their pixels are looked for around each pixel, kNearSeeds px far
    std::vector<CascadePlan> cascades;  // [0] is the nearest; empty when no light can arrive
    bool bilinear_fix = false;          // the cascades are those of `rc_fix`
    ReferencePlan reference;
    ExactPlan exact;                    // of the method `exact`; of `hybrid`, for the light of a few shapes; of others, what surfaces shine with is found by it
    HrcPlan hrc;                        // inactive unless this method, or `hybrid`, runs
    std::vector<int> solved_shapes;     // of `hybrid`: whose light is solved; that of all others is sampled
    DeltaPlan delta;                    // point, spot and directional lights
    FloorPlan floor;
    std::vector<glm::ivec2> closed_tiles;  // first pixels of tiles of kExactTile px that no light reaches: taken for solid
    bool lone = false;                  // pixels are interpolated between probes, which may all be inside of shapes
    bool resolve = false;               // false: cascade 0 already is the mean radiance per pixel
    bool half_floats = false;           // cascades in 16 bits, emission scaled to [0, 1]
    double radiance_scale = 1;          // emission is divided by this before it is packed
    int band_rows = 0;                  // the picture is composed and read this many rows at a time
    std::size_t gpu_bytes = 0;          // of textures, the packed scene left out
    std::vector<SkippedWork> skipped;
};

// How finely `rc` or `rc_fix` samples: a point on its time/error curve.
struct CascadeSettings {
    double spacing_px = 1;    // of cascade 0's probes
    double interval_px = 1;   // length of cascade 0's interval
    int base_tiles = 1;       // direction groups of cascade 0 along each axis: 4 * base_tiles^2 rays
    double growth = 2;        // of the spacing, from cascade 0 to cascade 1; 2 for all others
    double far_gap_px = 0;    // cascades end where neighbouring rays are this near at the diagonal's end; 0: as the intervals need
};
CascadeSettings cascade_settings(Quality quality);
CascadeSettings rc_fix_settings(Quality quality);

// Rays a pixel of the method `reference`.
int reference_rays(Quality quality);

// The cascades that cover a domain of this diagonal. n = ceil(log4(1 + 3 D / t0)): errata E-3, E-10.
std::vector<CascadePlan> plan_cascades(glm::ivec2 canvas, double diagonal_px, const CascadeSettings& settings);

// Leaves out the last cascades where none of their rays, nor those of the one that becomes the last, can meet what matters
// (what shines; under a sky, any shape): those see the sky or nothing. Returns how many.
std::size_t leave_out_far(std::vector<CascadePlan>& cascades, const Extent& matters, double diagonal_px);

// Leaves out the probes that no pixel of `lit` asks, directly or through the cascades below.
void keep_probes_near(std::vector<CascadePlan>& cascades, const PixelArea& lit);

// Steps of jump flooding over a grid: halving from the largest power of two below its longer side to 1, then
// twice 1 more (JFA+2: plain flooding is wrong at a few pixels).
std::vector<int> plan_jumps(glm::ivec2 grid);

GridPlan plan_grid(const Canvas& canvas);

// Precondition: validate(scene) and unsupported(scene) are empty. Shapes that nothing sees are left out before
// (core/plan/skip.h).
// `not_exact`: why `auto` may not take the method `exact` for this scene; empty: it may.
// Throws DeviceError when the device cannot hold the picture.
Plan make_plan(const Scene& scene, const DeviceLimits& limits, const std::string& not_exact = {});

}  // namespace penumbra
