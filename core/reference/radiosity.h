// SPDX-License-Identifier: MIT
// Light that surfaces reflect: boundary elements whose outgoing radiance is found by repeated exact
// gathers, and integrated over what a point sees with a linear course within each element.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/reference/delta.h"
#include "core/reference/sky.h"
#include "core/reference/sweep.h"

namespace penumbra::reference {

// Elements of the pieces that reflect. A piece without albedo has none: it only emits.
class Elements {
public:
    // `length`: the longest element in world units. Elements shorten towards the ends of pieces
    // (corners, where radiance bends) and at the edges of delta lights' shadows (where it jumps).
    Elements(const Boundary& boundary, const DeltaLights& lights, double length);

    std::size_t count() const { return elements_.size(); }
    bool has(std::int32_t piece) const {
        return first_[std::size_t(piece)] < first_[std::size_t(piece) + 1];
    }

    struct Element {
        Point middle{0}, normal{0}, tangent{0};
        std::int32_t piece = 0;
        double place = 0;    // of its middle along the piece, world units
        double size = 0;     // its length
        Colour radiance{0};  // at its middle
        Colour mean{0};      // over its length
        Colour slope{0};     // change of radiance per world unit along `tangent`
    };
    std::vector<Element>& all() { return elements_; }
    const std::vector<Element>& all() const { return elements_; }

    void restart();  // back to emission alone

    // Means and slopes from the radiance of neighbours on the same piece; slopes are limited so
    // that jumps make no overshoot.
    void reconstruct();

    // Halves the elements across which radiance bends by more than `share` of the mean reflected
    // radiance (edges of penumbras, corners). False when there are none.
    bool refine(double share, double least_size);

    // visit(element, from, to): the parts of elements within an interval that shows `piece`, ends
    // relative to `p`, in order of the interval.
    template <class Visit>
    void walk(const Interval& interval, Point p, const Visit& visit) const;

private:
    std::vector<double> first_knots(std::int32_t index, const DeltaLights& lights, double length,
                                    Sweep& sweep) const;
    void append(std::int32_t index, const std::vector<double>& knots);

    const Boundary& boundary_;
    std::vector<std::int32_t> first_;  // by piece, one more than pieces
    std::vector<double> knots_;        // parameters; piece i's start at first_[i] + i
    std::vector<Point> knot_points_;
    std::vector<Element> elements_;
};

// Radiance arriving at points. Threads share it; each brings its own Sweep.
struct Gather {
    const Boundary& boundary;
    const SkyIntegral& sky;
    const Elements* elements = nullptr;  // null: emission alone

    // Integrals over all directions, of radiance and of radiance times direction.
    struct Moments {
        Colour mean{0}, x{0}, y{0};
    };
    Moments moments(Point p, const std::vector<Interval>& seen) const;
    // Of the part of a piece without elements that is seen between two directions, whose emission is a gradient.
    Moments gradient_light(const Material& material, Point p, std::int32_t piece, Point from, Point to) const;

    // Integral of radiance over all directions.
    Colour fluence(Point p, const std::vector<Interval>& seen) const;
    // Integral of radiance times cosine over the half circle about `normal`.
    Colour irradiance(Point p, Point normal, const std::vector<Interval>& seen) const;
};

// What `reflect` does before it solves: at most so many rounds that halve elements, down to this
// size in world units, where radiance bends by more than this share of its mean.
struct Refinement {
    int rounds = 5;
    double least_size = 0;
    double share = 3e-5;
};

// Runs `bounces` rounds of reflection. `parallel(count, body)` runs body(index, sweep) for each
// index.
using Parallel = std::function<bool(std::size_t, const std::function<void(std::size_t, Sweep&)>&)>;
// `converged`: ends once no element changes by more than this share of the brightest; 0: does not.
bool reflect(Elements& elements, const Boundary& boundary, const SkyIntegral& sky,
             const DeltaLights& lights, int bounces, double converged, const Refinement& refinement,
             const Parallel& parallel);

}  // namespace penumbra::reference
