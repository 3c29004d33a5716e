// SPDX-License-Identifier: MIT
#include "core/outline/rings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <unordered_map>
#include <utility>

namespace penumbra {
namespace {

// On a grid of whole numbers every question of sides has an exact answer.
constexpr std::int64_t kExtent = std::int64_t(1) << 26;
// Splitting rounds crossings to the grid, which may make new ones: a few rounds find them all.
constexpr int kRounds = 12;
// Questions asked of pairs of edges: about a second.
constexpr double kMostQuestions = 3e8;

struct Node {
    std::int64_t x = 0, y = 0;
    auto operator<=>(const Node&) const = default;
};

struct Edge {
    Node a, b;
};

// More than 0 where p lies on the left of a to b (y up).
std::int64_t side_of(Node a, Node b, Node p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

bool between(std::int64_t a, std::int64_t b, std::int64_t v) { return std::min(a, b) <= v && v <= std::max(a, b); }

// Of a point on the edge's line: strictly between its ends.
bool within(const Edge& edge, Node p) {
    return p != edge.a && p != edge.b && between(edge.a.x, edge.b.x, p.x) && between(edge.a.y, edge.b.y, p.y);
}

Node crossing(const Edge& e, const Edge& f) {
    const double t = double(side_of(f.a, f.b, e.a)) / (double(side_of(f.a, f.b, e.a)) - double(side_of(f.a, f.b, e.b)));
    return {e.a.x + std::llround(t * double(e.b.x - e.a.x)), e.a.y + std::llround(t * double(e.b.y - e.a.y))};
}

// Which edges may meet: by cells of a coarse grid.
class Cells {
public:
    explicit Cells(const std::vector<Edge>& edges) {
        cells_ = std::clamp<std::int64_t>(std::int64_t(std::sqrt(double(edges.size()))), 1, 256);
        lists_.resize(std::size_t(cells_ * cells_));
        for (std::size_t i = 0; i < edges.size(); ++i) {
            // Row by row, only as far as the edge reaches in it (and a little more, for rounding).
            const Edge& e = edges[i];
            const Edge up = e.a.y <= e.b.y ? e : Edge{e.b, e.a};
            const double slope = up.a.y == up.b.y ? 0 : double(up.b.x - up.a.x) / double(up.b.y - up.a.y);
            const std::int64_t y0 = cell(up.a.y), y1 = cell(up.b.y);
            for (std::int64_t y = y0; y <= y1; ++y) {
                const double height = double(kExtent + 1) / double(cells_);
                const double low = std::max(double(up.a.y), double(y) * height), high = std::min(double(up.b.y), double(y + 1) * height);
                double from = double(up.a.x) + (low - double(up.a.y)) * slope, to = double(up.a.x) + (high - double(up.a.y)) * slope;
                if (up.a.y == up.b.y) from = double(up.a.x), to = double(up.b.x);
                const std::int64_t x0 = cell(std::int64_t(std::min(from, to)) - 2), x1 = cell(std::int64_t(std::max(from, to)) + 2);
                for (std::int64_t x = x0; x <= x1; ++x) lists_[std::size_t(y * cells_ + x)].push_back(i);
            }
        }
    }
    const std::vector<std::vector<std::size_t>>& lists() const { return lists_; }

private:
    std::int64_t cell(std::int64_t v) const { return std::clamp<std::int64_t>(v * cells_ / (kExtent + 1), 0, cells_ - 1); }
    std::int64_t cells_ = 1;
    std::vector<std::vector<std::size_t>> lists_;
};

// Where edges are to be split; false when they meet too often.
bool find_splits(const std::vector<Edge>& edges, std::size_t most, std::vector<std::vector<Node>>& splits, std::size_t& count) {
    splits.assign(edges.size(), {});
    count = 0;
    const auto split = [&](std::size_t i, Node p) {
        if (p == edges[i].a || p == edges[i].b || std::find(splits[i].begin(), splits[i].end(), p) != splits[i].end()) return;
        splits[i].push_back(p);
        ++count;
    };
    const Cells cells(edges);
    double questions = 0;
    for (const std::vector<std::size_t>& list : cells.lists()) {
        questions += double(list.size()) * double(list.size()) / 2;
        if (questions > kMostQuestions) return false;
        for (std::size_t m = 0; m < list.size(); ++m) {
            for (std::size_t n = m + 1; n < list.size(); ++n) {
                const std::size_t i = list[m], j = list[n];
                const Edge &e = edges[i], &f = edges[j];
                if (std::max(e.a.x, e.b.x) < std::min(f.a.x, f.b.x) || std::max(f.a.x, f.b.x) < std::min(e.a.x, e.b.x) ||
                    std::max(e.a.y, e.b.y) < std::min(f.a.y, f.b.y) || std::max(f.a.y, f.b.y) < std::min(e.a.y, e.b.y))
                    continue;
                const std::int64_t fa = side_of(e.a, e.b, f.a), fb = side_of(e.a, e.b, f.b);
                const std::int64_t ea = side_of(f.a, f.b, e.a), eb = side_of(f.a, f.b, e.b);
                if (fa == 0 && within(e, f.a)) split(i, f.a);
                if (fb == 0 && within(e, f.b)) split(i, f.b);
                if (ea == 0 && within(f, e.a)) split(j, e.a);
                if (eb == 0 && within(f, e.b)) split(j, e.b);
                if (fa != 0 && fb != 0 && ea != 0 && eb != 0 && (fa > 0) != (fb > 0) && (ea > 0) != (eb > 0)) {
                    const Node p = crossing(e, f);
                    split(i, p);
                    split(j, p);
                }
                if (count > most) return false;
            }
        }
    }
    return true;
}

std::vector<Edge> split_edges(const std::vector<Edge>& edges, std::vector<std::vector<Node>>& splits) {
    std::vector<Edge> out;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& e = edges[i];
        const auto along = [&](Node p) { return (p.x - e.a.x) * (e.b.x - e.a.x) + (p.y - e.a.y) * (e.b.y - e.a.y); };
        std::sort(splits[i].begin(), splits[i].end(), [&](Node p, Node q) { return along(p) < along(q); });
        Node from = e.a;
        splits[i].push_back(e.b);
        for (const Node to : splits[i]) {
            if (to != from) out.push_back({from, to});
            from = to;
        }
    }
    return out;
}

// An edge once, with how often the rings pass it upwards (from the smaller node) less downwards.
struct NetEdge {
    Node a, b;
    int times = 0;
};

std::vector<NetEdge> net_edges(const std::vector<Edge>& edges) {
    std::map<std::pair<Node, Node>, int> times;
    for (const Edge& e : edges) {
        if (e.a < e.b)
            ++times[{e.a, e.b}];
        else
            --times[{e.b, e.a}];
    }
    std::vector<NetEdge> out;
    for (const auto& [ends, count] : times)
        if (count != 0) out.push_back({ends.first, ends.second, count});
    return out;
}

// Edges by the bands that they reach into across a ray's direction.
class Bands {
public:
    Bands(const std::vector<NetEdge>& edges, bool along_x) : edges_(edges), along_x_(along_x) {
        bands_ = std::clamp<std::int64_t>(std::int64_t(edges.size() / 4), 1, 1024);
        lists_.resize(std::size_t(bands_));
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const std::int64_t a = across(edges[i].a), b = across(edges[i].b);
            for (std::int64_t band = band_of(std::min(a, b)); band <= band_of(std::max(a, b)); ++band)
                lists_[std::size_t(band)].push_back(i);
        }
    }

    // All of beyond() together.
    double questions() const {
        double sum = 0;
        for (const std::vector<std::size_t>& list : lists_) sum += double(list.size()) * double(list.size());
        return sum;
    }

    // The winding number just beyond the middle of edge `i`, on the side of growing x (or y). Coordinates are doubled, so that the middle
    // is on the grid; the edges beyond it are those that it lies before, which is exact.
    int beyond(std::size_t i) const {
        const NetEdge& e = edges_[i];
        const Node middle{e.a.x + e.b.x, e.a.y + e.b.y};
        int winding = 0;
        for (const std::size_t j : lists_[std::size_t(band_of(across(middle) / 2))]) {
            if (j == i) continue;
            const Node a{2 * edges_[j].a.x, 2 * edges_[j].a.y}, b{2 * edges_[j].b.x, 2 * edges_[j].b.y};
            const bool up = across(a) <= across(middle), down = across(b) <= across(middle);
            if (up == down) continue;
            // Of a ray along x: to its right, an edge that goes up turns once.
            const std::int64_t side = along_x_ ? side_of(a, b, middle) : -side_of(a, b, middle);
            const bool rises = up;
            if ((side > 0) == rises) winding += rises ? edges_[j].times : -edges_[j].times;
        }
        return along_x_ ? winding : -winding;
    }

private:
    std::int64_t across(Node p) const { return along_x_ ? p.y : p.x; }
    std::int64_t band_of(std::int64_t v) const { return std::clamp<std::int64_t>(v * bands_ / (kExtent + 1), 0, bands_ - 1); }

    const std::vector<NetEdge>& edges_;
    bool along_x_;
    std::int64_t bands_ = 1;
    std::vector<std::vector<std::size_t>> lists_;
};

// The edges between filled and empty, each with the filled side on its left.
std::optional<std::vector<Edge>> borders(const std::vector<NetEdge>& edges) {
    const Bands rows(edges, true), columns(edges, false);
    if (rows.questions() + columns.questions() > 4 * kMostQuestions) return std::nullopt;
    std::vector<Edge> out;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const NetEdge& e = edges[i];
        // Beyond a rising edge is its right, beyond one to the right is its left (y up); a winding number is larger on the left.
        int left = 0, right = 0;
        if (e.a.y != e.b.y) {
            const int beyond = rows.beyond(i);
            const bool rises = e.b.y > e.a.y;
            left = rises ? beyond + e.times : beyond;
            right = rises ? beyond : beyond - e.times;
        } else {
            left = columns.beyond(i);  // the smaller node comes first: it runs to the right
            right = left - e.times;
        }
        if ((left != 0) == (right != 0)) continue;
        out.push_back(left != 0 ? Edge{e.a, e.b} : Edge{e.b, e.a});
    }
    return out;
}

struct NodeHash {
    std::size_t operator()(Node p) const { return std::hash<std::uint64_t>()(std::uint64_t(p.x) * 0x9e3779b97f4a7c15u + std::uint64_t(p.y)); }
};

// As many edges end at each node as start there, so that each walk comes back to where it began.
std::vector<std::vector<Node>> chained(const std::vector<Edge>& edges) {
    std::unordered_map<Node, std::vector<Node>, NodeHash> next;
    for (const Edge& e : edges) next[e.a].push_back(e.b);
    std::vector<std::vector<Node>> rings;
    for (const Edge& e : edges) {
        std::vector<Node> ring;
        Node at = e.a;
        for (auto found = next.find(at); found != next.end() && !found->second.empty(); found = next.find(at)) {
            ring.push_back(at);
            at = found->second.back();
            found->second.pop_back();
        }
        if (!ring.empty()) rings.push_back(std::move(ring));
    }
    return rings;
}

}  // namespace

std::optional<std::vector<Ring>> even_odd_of_nonzero(const std::vector<Ring>& rings, std::size_t most_points) {
    Point low(1e300), high(-1e300);
    for (const Ring& ring : rings)
        for (const Point& p : ring) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    const double extent = std::max(high.x - low.x, high.y - low.y);
    if (!(extent > 0)) return std::vector<Ring>{};
    const double scale = double(kExtent) / extent;
    std::vector<Edge> edges;
    for (const Ring& ring : rings) {
        std::vector<Node> nodes;
        for (const Point& p : ring) nodes.push_back({std::llround((p.x - low.x) * scale), std::llround((p.y - low.y) * scale)});
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Edge e{nodes[i], nodes[(i + 1) % nodes.size()]};
            if (e.a != e.b) edges.push_back(e);
        }
    }
    std::vector<std::vector<Node>> splits;
    for (int round = 0; round < kRounds; ++round) {
        std::size_t count = 0;
        if (!find_splits(edges, most_points, splits, count)) return std::nullopt;
        if (count == 0) break;
        edges = split_edges(edges, splits);
    }
    const auto kept = borders(net_edges(edges));
    if (!kept) return std::nullopt;
    std::vector<Ring> out;
    for (const std::vector<Node>& nodes : chained(*kept)) {
        Ring ring;
        for (const Node p : nodes) ring.push_back(low + Point(double(p.x), double(p.y)) / scale);
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
