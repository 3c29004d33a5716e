// SPDX-License-Identifier: MIT
// The sky as a piecewise linear function of direction, integrated in closed form.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace penumbra::reference {

class SkyIntegral {
public:
    explicit SkyIntegral(const Sky& sky);

    bool is_black() const { return is_black_; }
    Colour radiance(double angle) const;
    // Integral over directions from `angle` (radians, any) on by `extent` in [0, 2 pi].
    Colour integral(double angle, double extent) const;
    // The same, each direction weighted by the cosine of its angle from `normal_angle`.
    Colour cosine_integral(double angle, double extent, double normal_angle) const;

private:
    struct Piece {
        double from, to;  // radians, within [0, 2 pi], from < to
        Colour start, slope;
        Colour before;  // integral over all earlier pieces
    };
    Colour integral_from_zero(double angle) const;
    const Piece& piece_at(double angle) const;

    std::vector<Piece> pieces_;  // cover [0, 2 pi]
    Colour total_{0};
    bool is_black_ = true;
};

}  // namespace penumbra::reference
