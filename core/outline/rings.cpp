// SPDX-License-Identifier: MIT
#include "core/outline/rings.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra {
namespace {

// Splitting rounds crossings to the grid, which may make new ones: a few rounds find them all, but for some on the narrowest of grids.
// More than the usual ones are paid for.
constexpr int kRounds = 12, kFreeRounds = 3;
// What an edge asks another about a ray takes about a hundredth of the time of a crossing.
constexpr double kQuestionsForOneUnit = 64;

// The splits of each edge lie in its direction.
std::vector<GridEdge> split_edges(const std::vector<GridEdge>& edges, const std::vector<std::vector<GridNode>>& splits, std::size_t count) {
    std::vector<GridEdge> out;
    out.reserve(edges.size() + count);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        GridNode from = edges[i].a;
        for (const GridNode to : splits[i]) {
            if (to != from) out.push_back({from, to});
            from = to;
        }
        if (edges[i].b != from) out.push_back({from, edges[i].b});
    }
    return out;
}

std::vector<NetEdge> net_edges(const std::vector<GridEdge>& edges) {
    std::vector<NetEdge> all;
    all.reserve(edges.size());
    for (const GridEdge& e : edges) all.push_back(e.a < e.b ? NetEdge{e.a, e.b, 1} : NetEdge{e.b, e.a, -1});
    const auto ends = [](const NetEdge& e) { return std::pair(e.a, e.b); };
    std::sort(all.begin(), all.end(), [&](const NetEdge& e, const NetEdge& f) { return ends(e) < ends(f); });
    std::vector<NetEdge> out;
    for (std::size_t i = 0; i < all.size();) {
        NetEdge sum = all[i];
        for (++i; i < all.size() && ends(all[i]) == ends(sum); ++i) sum.times += all[i].times;
        if (sum.times != 0) out.push_back(sum);
    }
    return out;
}

// The edges between filled and empty, each with the filled side on its left; `right` are the windings on their right.
std::vector<GridEdge> borders(const std::vector<NetEdge>& edges, const std::vector<int>& right) {
    std::vector<GridEdge> out;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const bool left_filled = right[i] + edges[i].times != 0, right_filled = right[i] != 0;
        if (left_filled == right_filled) continue;
        out.push_back(left_filled ? GridEdge{edges[i].a, edges[i].b} : GridEdge{edges[i].b, edges[i].a});
    }
    return out;
}

// As many edges end at each node as start there, so that each walk comes back to where it began.
std::vector<std::vector<GridNode>> chained(const std::vector<GridEdge>& edges) {
    // By where they start, those of one node in their order; a walk takes the last one that is left.
    std::vector<std::pair<GridNode, std::size_t>> starts;
    for (std::size_t i = 0; i < edges.size(); ++i) starts.push_back({edges[i].a, i});
    std::sort(starts.begin(), starts.end());
    const auto first_at = [&](GridNode p) {
        return std::size_t(std::lower_bound(starts.begin(), starts.end(), std::pair(p, std::size_t(0))) - starts.begin());
    };
    std::vector<std::size_t> left(starts.size(), 0);  // of each node, at its first edge's place
    for (std::size_t i = 0, first = 0; i < starts.size(); ++i) {
        if (starts[i].first != starts[first].first) first = i;
        ++left[first];
    }
    std::vector<std::vector<GridNode>> rings;
    for (const GridEdge& e : edges) {
        std::vector<GridNode> ring;
        GridNode at = e.a;
        for (std::size_t first = first_at(at); first < starts.size() && starts[first].first == at && left[first] > 0; first = first_at(at)) {
            ring.push_back(at);
            at = edges[starts[first + --left[first]].second].b;
        }
        if (!ring.empty()) rings.push_back(std::move(ring));
    }
    return rings;
}

}  // namespace

std::optional<std::vector<Ring>> even_odd_of_nonzero(const std::vector<Ring>& rings, std::size_t most_splits, CrossingWork& work) {
    Point low(1e300), high(-1e300);
    for (const Ring& ring : rings)
        for (const Point& p : ring) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    const double extent = std::max(high.x - low.x, high.y - low.y);
    if (!(extent > 0)) return std::vector<Ring>{};
    const double scale = double(kGridExtent) / extent;
    if (!std::isfinite(extent) || !std::isfinite(scale)) return rings;
    std::vector<GridEdge> edges;
    for (const Ring& ring : rings) {
        std::vector<GridNode> nodes;
        for (const Point& p : ring) nodes.push_back({std::llround((p.x - low.x) * scale), std::llround((p.y - low.y) * scale)});
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const GridEdge e{nodes[i], nodes[(i + 1) % nodes.size()]};
            if (e.a != e.b) edges.push_back(e);
        }
    }
    std::vector<std::vector<GridNode>> splits;
    std::size_t count = 1;
    for (int round = 0; round < kRounds && count > 0; ++round) {
        if (round >= kFreeRounds) {
            if (work.left < edges.size()) return std::nullopt;
            work.left -= edges.size();
        }
        if (!find_splits(edges, most_splits, splits, count, work)) return std::nullopt;
        if (count > 0) edges = split_edges(edges, splits, count);
    }
    const std::vector<NetEdge> net = net_edges(edges);
    std::vector<int> right;
    if (count == 0) {
        right = windings_on_the_right(net);
    } else {
        const double cost = double(net.size()) * double(net.size()) / kQuestionsForOneUnit;
        if (cost > double(work.left)) return std::nullopt;
        work.left -= std::size_t(cost);
        right = windings_by_rays(net);
    }
    std::vector<Ring> out;
    for (const std::vector<GridNode>& nodes : chained(borders(net, right))) {
        Ring ring;
        for (const GridNode p : nodes) ring.push_back(low + Point(double(p.x), double(p.y)) / scale);
        out.push_back(std::move(ring));
    }
    return out;
}

Polygon polygon_of(const std::vector<Ring>& rings) {
    Polygon polygon;
    for (const Ring& ring : rings) {
        std::vector<Point> distinct;
        for (const Point& p : ring) {
            if (std::find(distinct.begin(), distinct.end(), p) == distinct.end()) distinct.push_back(p);
            if (distinct.size() == 3) break;
        }
        if (distinct.size() < 3) continue;
        if (!polygon.points.empty()) polygon.ring_starts.push_back(polygon.points.size());
        polygon.points.insert(polygon.points.end(), ring.begin(), ring.end());
    }
    return polygon;
}

}  // namespace penumbra
