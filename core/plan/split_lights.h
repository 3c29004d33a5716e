// SPDX-License-Identifier: MIT
// Which shapes the method `hybrid` solves: docs/methods/hybrid.md tells the figures behind it.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/scene.h"

namespace penumbra {

struct LightSplit {
    std::vector<int> solved;  // shapes whose light is solved; that of all others, and of the sky, is sampled
    std::size_t lamps = 0;    // shapes that shine and can be seen
    double share = 0;         // of the error of sampling all lamps, about that of the solved ones
    double cost = 0;          // of solving them, in the units of exact_cost()
    bool all() const { return solved.size() == lamps; }
};

// All lamps where that costs what `auto` would solve them for; else the brightest that together are least_solved_share() of all; where
// those cost more than most_solved_cost(), as many of them as do not, but at least one. A lamp counts by the mean of the channels of
// its radiance times the length of its outline that can be seen, over its extent. `most_pieces` as for pack_outline(); empty where
// there are more.
LightSplit split_lights(const Scene& scene, std::size_t most_pieces);

double most_solved_cost(Quality quality);
double least_solved_share();

// The scene in which only the solved shapes shine, without a sky; and the one in which all but they do.
Scene solved_part(const Scene& scene, const std::vector<int>& solved);
Scene sampled_part(const Scene& scene, const std::vector<int>& solved);

}  // namespace penumbra
