// SPDX-License-Identifier: MIT
#include "core/plan/choose.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace penumbra {
namespace {

// Where `exact` takes as long as `rc` of the same quality, or up to twice that at a hundredth of its error.
constexpr double kMostCost = 25'000;
// The same for `high`, whose cascades cost four times as much and more.
constexpr double kMostCostHigh = 100'000;
// Of what solving all lamps takes: those that are solved may take this share.
constexpr double kMostOfAll = 0.25;

}  // namespace

double exact_cost(const PackedOutline& outline) { return outline.mean_intervals * double(outline.pieces); }

std::size_t most_surveyed_pieces() { return 20'000; }

MethodChoice choose_method(const PackedOutline& outline, Quality quality) {
    if (!outline.fits) return {"hrc", "more than " + std::to_string(most_surveyed_pieces()) + " pieces of outline"};
    std::ostringstream seen;
    seen << outline.pieces << " pieces of outline, of which a point tells " << std::round(outline.mean_intervals)
         << " intervals of direction apart";
    const double most = quality == Quality::high ? kMostCostHigh : kMostCost;
    if (exact_cost(outline) <= most) return {"exact", seen.str() + ": solved sooner than sampled"};
    return {"hrc", seen.str() + ": sampled sooner than solved"};
}

MethodChoice choose_split(const LightSplit& split, const PackedOutline& outline, Quality quality, const MethodChoice& sampled) {
    const double most = std::min(most_solved_cost(quality), kMostOfAll * exact_cost(outline));
    if (split.solved.empty() || split.share < least_solved_share() || split.cost > most) return sampled;
    std::ostringstream reason;
    reason << sampled.reason << "; but of " << split.lamps << " lamps the brightest " << split.solved.size() << ", "
           << std::floor(100 * split.share) << " % of what sampling would err by, are solved";
    return {"hybrid", reason.str()};
}

}  // namespace penumbra
