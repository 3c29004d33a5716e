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
    double share = 0;         // of the power of all lamps, that of the solved ones
    double cost = 0;          // of solving them, in the units of exact_cost()
    bool all() const { return solved.size() == lamps; }
};

// The lamps of most power: at least one and those that together send `least_share` of all light, and as many more as can be solved
// for `most_cost`. Whether the first of them can is for the caller to see. Power is the mean of the channels of a lamp's radiance
// times the length of its outline that can be seen. `most_pieces` as for pack_outline(); empty where there are more.
LightSplit split_lights(const Scene& scene, double least_share, double most_cost, std::size_t most_pieces);

// The most that solving may cost: of the method `hybrid` asked for by name, and of what `auto` takes it for.
double most_solved_cost(Quality quality);
double most_solved_cost_by_choice(Quality quality);

// Less than this share of the power is not worth a second method: the error of what is sampled falls by the share that is not.
double least_solved_share();

// The scene in which only the solved shapes shine, without a sky; and the one in which all but they do.
Scene solved_part(const Scene& scene, const std::vector<int>& solved);
Scene sampled_part(const Scene& scene, const std::vector<int>& solved);

}  // namespace penumbra
