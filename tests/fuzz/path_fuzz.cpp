// SPDX-License-Identifier: MIT
// Any bytes as SVG path data: refused at a place in it, or finite rings, whose nonzero filling is found or given up.
#include <cmath>

#include "check.h"
#include "core/outline/path_data.h"

using namespace penumbra;
using fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kMostPoints = 512;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const double tolerance : {0.05, 1e-9}) {
        const auto result = rings_of_path(text, tolerance, kMostPoints);
        if (const auto* error = std::get_if<PathError>(&result)) {
            check(error->at <= size && !error->message.empty(), "a refusal names a place");
            continue;
        }
        const auto& rings = std::get<std::vector<Ring>>(result);
        std::size_t points = 0;
        for (const Ring& ring : rings) {
            points += ring.size();
            for (const Point& point : ring) check(std::isfinite(point.x) && std::isfinite(point.y), "points are finite");
        }
        if (points > kMostPoints) continue;  // refused by the validation
        CrossingWork work{1u << 14};
        if (const auto filled = even_odd_of_nonzero(rings, 4 * kMostPoints, work)) {
            for (const Ring& ring : *filled) {
                for (const Point& point : ring) check(std::isfinite(point.x) && std::isfinite(point.y), "filled points are finite");
            }
            polygon_of(*filled);
        }
    }
    return 0;
}
