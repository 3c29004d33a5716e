// SPDX-License-Identifier: MIT
// Where straight edges between the nodes of a grid meet, by a plane sweep (Bentley and Ottmann 1979; de Berg et al., Computational
// Geometry, chapter 2) in whole numbers: every question of sides and of order has an exact answer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra {

// Coordinates lie from 0 to this.
constexpr std::int64_t kGridExtent = std::int64_t(1) << 26;

struct GridNode {
    std::int64_t x = 0, y = 0;
    auto operator<=>(const GridNode&) const = default;
};

struct GridEdge {
    GridNode a, b;
};

// An edge once, from its smaller node to its larger one, with how often rings pass it in this direction less in the other.
struct NetEdge {
    GridNode a, b;
    int times = 0;
};

// More than 0 where p lies on the left of a to b (y up).
inline std::int64_t side_of(GridNode a, GridNode b, GridNode p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

// What crossings may still cost: places where edges cross and pairs of edges asked there.
struct CrossingWork {
    std::size_t left = 0;
};

// The nodes at which each edge is to be split, in its direction: where the end of another lies inside it, and where it crosses another, rounded to
// the grid. False when there are more than `most` in all, or the work is used up.
bool find_splits(const std::vector<GridEdge>& edges, std::size_t most, std::vector<std::vector<GridNode>>& splits, std::size_t& count, CrossingWork& work);

// The winding number on the right of each edge; on its left it is larger by `times`. The edges meet in their ends only.
std::vector<int> windings_on_the_right(const std::vector<NetEdge>& edges);
// The same by a ray from the middle of each edge, by the square of their number: an edge that crosses another errs alone.
std::vector<int> windings_by_rays(const std::vector<NetEdge>& edges);

}  // namespace penumbra
