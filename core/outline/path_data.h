// SPDX-License-Identifier: MIT
// SVG path data (the attribute `d`: W3C, SVG 2, section 9.3) to rings of straight edges.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/outline/rings.h"

namespace penumbra {

// Why a text is no path data: what was expected at which byte.
struct PathError {
    std::size_t at = 0;
    std::string message;
};

// Every subpath as a ring, closed whether it says so or not. Curves become edges that are nowhere more than `tolerance` from them.
// Ends once there are more than `most_points`.
std::variant<std::vector<Ring>, PathError> rings_of_path(std::string_view data, double tolerance, std::size_t most_points);

// Straight edges of a curve, each point but the first appended to the ring, whose last point is the curve's start.
void append_quadratic(Ring& ring, Point control, Point end, double tolerance);
void append_cubic(Ring& ring, Point first, Point second, Point end, double tolerance);

}  // namespace penumbra
