// SPDX-License-Identifier: MIT
#include "core/plan/survey.h"

#include "core/reference/sweep.h"

namespace penumbra {

double survey_intervals(const Scene& scene, const reference::Boundary& boundary, const std::vector<char>* shining) {
    constexpr int kSide = 6;
    reference::Sweep sweep(boundary, shining);
    const ViewRect view = scene.canvas.view_or_default();
    double intervals = 0;
    int points = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            // Not quite regular, for scenes that are.
            const Point p{view.x + (x + 0.5 + 0.13 * (y % 3 - 1)) * view.w / kSide,
                          view.y + (y + 0.5 + 0.11 * (x % 3 - 1)) * view.h / kSide};
            if (boundary.is_solid(p)) continue;
            intervals += double(sweep.look(p, {1, 0}, 0, false).size());
            ++points;
        }
    }
    return points > 0 ? intervals / points : 0;
}

}  // namespace penumbra
