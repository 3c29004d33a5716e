// SPDX-License-Identifier: MIT
// Where outline pieces meet one another.
#pragma once

#include <vector>

#include "core/reference/outlines.h"

namespace penumbra::reference {

// A point of two pieces, with its parameter on each.
struct Meeting {
    double t_first = 0;
    double t_second = 0;
    Point point{0};
};

// Appends every meeting of the two pieces: proper crossings, and ends of one that lie within
// `tolerance` of the other (so pieces that touch or coincide are split where the other one ends).
void find_meetings(const Piece& first, const Piece& second, double tolerance,
                   std::vector<Meeting>& out);

// Roots in [0, 2 pi) of  c0 + c1 cos t + s1 sin t + c2 cos 2t + s2 sin 2t  where it changes sign.
struct TrigPolynomial {
    double c0 = 0, c1 = 0, s1 = 0, c2 = 0, s2 = 0;

    double value(double t) const;
    double slope(double t) const;
    std::vector<double> roots() const;
};

}  // namespace penumbra::reference
