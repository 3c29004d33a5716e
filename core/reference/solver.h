// SPDX-License-Identifier: MIT
// The exact solver: what every renderer is measured against. docs/methods/exact.md tells the
// method, what is exact and what is not.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/image/image.h"
#include "core/scene/problem.h"
#include "core/scene/scene.h"

namespace penumbra::reference {

// Pixels x0 <= x < x1, y0 <= y < y1.
struct Region {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct SolveOptions {
    // Solve every N-th pixel in both axes, starting in the middle of the first N. The picture keeps
    // its size; pixels left out are NaN, which error figures leave out too.
    int stride = 1;
    std::optional<Region> region;  // pixels outside are NaN
    int threads = 0;               // 0: one for each processor
    // Longest boundary element, in pixels; matters only when bounces > 0.
    double element_length_px = 0.5;
    // Outlines of more pieces are refused: each pixel looks at all of them.
    std::size_t max_pieces = 500'000;
    // Called on the calling thread, a few times a second, with the share of the work done (0 to 1).
    // Returning false cancels.
    std::function<bool(double fraction)> progress;
};

struct Solution {
    // 3 channels, linear, rows top to bottom; NaN where a pixel is solid or was left out.
    ImageF image;
    double seconds = 0;
    std::uint64_t intervals = 0;  // of direction, over all pixels: the exact counterpart of rays
    std::size_t pieces = 0;       // of outline that can be seen
    std::size_t elements = 0;     // that reflect; 0 without bounces
    bool cancelled = false;       // then the picture is incomplete
    Problems problems;            // not empty: refused, and there is no picture
};

// Expects a validated scene (core/scene/validate.h). The picture is `canvas.region` of the canvas, where the scene has one.
Solution solve(const Scene& scene, const SolveOptions& options = {});

// The same at single points, for tests and probes. Building it does the work that all points share
// (with bounces: all of the radiosity). Its functions may be called from one thread at a time.
class ExactSolver {
public:
    explicit ExactSolver(const Scene& scene, const SolveOptions& options = {});
    ~ExactSolver();
    ExactSolver(ExactSolver&&) noexcept;
    ExactSolver& operator=(ExactSolver&&) noexcept;

    const Problems& problems() const;
    bool cancelled() const;
    bool is_solid(Point p) const;
    // phi: the mean radiance at a free point. No delta lights, no floor.
    Colour mean_radiance(Point p);
    // What point, spot and directional lights add to it.
    Colour delta_radiance(Point p);
    // What a free pixel with its centre at `p` holds.
    Colour value(Point p);

private:
    friend Solution solve(const Scene& scene, const SolveOptions& options);
    struct State;
    std::unique_ptr<State> state_;
};

// phi at one point of a scene: builds a solver for it.
Colour mean_radiance_at(const Scene& scene, Point p);

}  // namespace penumbra::reference
