// SPDX-License-Identifier: MIT
#include "core/outline/crossings.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace penumbra {
namespace {

__extension__ using Wide = __int128;

// A place between nodes: (x + xr / den, y + yr / den), the rests from 0 to below den.
struct Place {
    std::int64_t x = 0, y = 0;
    std::int64_t xr = 0, yr = 0, den = 1;
};

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

// By x, then by y: the order in which the sweep comes to them.
int compare(const Place& p, const Place& q) {
    if (p.x != q.x) return p.x < q.x ? -1 : 1;
    if (p.xr != 0 || q.xr != 0) {
        if (const int rest = sign(Wide(p.xr) * q.den - Wide(q.xr) * p.den); rest != 0) return rest;
    }
    if (p.y != q.y) return p.y < q.y ? -1 : 1;
    return p.yr == 0 && q.yr == 0 ? 0 : sign(Wide(p.yr) * q.den - Wide(q.yr) * p.den);
}

struct Later {
    bool operator()(const Place& p, const Place& q) const { return compare(p, q) > 0; }
};

// Of an edge from its smaller node to its larger one.
struct Span {
    GridNode low, high;
};

// 1 above the edge, 0 on its line, -1 below; above is the left of an edge that runs to the right, or upwards.
int side(const Span& e, const Place& p) {
    const std::int64_t whole = side_of(e.low, e.high, {p.x, p.y});
    if (p.den == 1) return sign(whole);
    const std::int64_t dx = e.high.x - e.low.x, dy = e.high.y - e.low.y;
    const std::int64_t most = dx + std::abs(dy);  // that the rests can change
    if (whole > most) return 1;
    if (whole < -most) return -1;
    return sign(Wide(whole) * p.den + Wide(dx) * p.yr - Wide(dy) * p.xr);
}

// Which lies above the other just beyond a place that both pass.
bool below_beyond(const Span& e, const Span& f) {
    return (e.high.x - e.low.x) * (f.high.y - f.low.y) > (e.high.y - e.low.y) * (f.high.x - f.low.x);
}

// value / den, rounded down, and the rest.
std::pair<std::int64_t, std::int64_t> divided(Wide value, std::int64_t den) {
    std::int64_t quotient = std::int64_t(value / den);
    std::int64_t rest = std::int64_t(value % den);
    if (rest < 0) {
        --quotient;
        rest += den;
    }
    return {quotient, rest};
}

// Inside both, not in an end of one.
bool cross(const Span& e, const Span& f) {
    if (std::max(e.low.y, e.high.y) < std::min(f.low.y, f.high.y) || std::max(f.low.y, f.high.y) < std::min(e.low.y, e.high.y)) return false;
    const std::int64_t fl = side_of(e.low, e.high, f.low), fh = side_of(e.low, e.high, f.high);
    if (fl == 0 || fh == 0 || (fl > 0) == (fh > 0)) return false;
    const std::int64_t el = side_of(f.low, f.high, e.low), eh = side_of(f.low, f.high, e.high);
    return el != 0 && eh != 0 && (el > 0) != (eh > 0);
}

Place crossing_place(const Span& e, const Span& f) {
    const std::int64_t el = side_of(f.low, f.high, e.low), eh = side_of(f.low, f.high, e.high);
    const std::int64_t den = std::abs(el - eh), t = std::abs(el);
    const auto [x, xr] = divided(Wide(t) * (e.high.x - e.low.x), den);
    const auto [y, yr] = divided(Wide(t) * (e.high.y - e.low.y), den);
    if (xr == 0 && yr == 0) return {e.low.x + x, e.low.y + y};
    return {e.low.x + x, e.low.y + y, xr, yr, den};
}

// As crossing_place(), rounded to the grid.
GridNode crossing_node(const GridEdge& e, const GridEdge& f) {
    const double t = double(side_of(f.a, f.b, e.a)) / (double(side_of(f.a, f.b, e.a)) - double(side_of(f.a, f.b, e.b)));
    return {e.a.x + std::llround(t * double(e.b.x - e.a.x)), e.a.y + std::llround(t * double(e.b.y - e.a.y))};
}

// The edges that the sweep line meets, from below to above; and the nodes that it will come to.
class Sweep {
public:
    explicit Sweep(std::vector<Span> spans) : spans_(std::move(spans)) {
        nodes_.reserve(2 * spans_.size());
        for (std::size_t i = 0; i < spans_.size(); ++i) {
            nodes_.push_back({key(spans_[i].low), std::uint32_t(2 * i)});
            nodes_.push_back({key(spans_[i].high), std::uint32_t(2 * i + 1)});
        }
        std::sort(nodes_.begin(), nodes_.end());
    }

    const Span& span(std::uint32_t i) const { return spans_[i]; }
    bool at_end() const { return next_ == nodes_.size(); }
    Place next_node() const { return {std::int64_t(nodes_[next_].first >> 32), std::int64_t(nodes_[next_].first & 0xffffffff)}; }

    // The edges that start at the next node, behind `starting`; the node is done.
    void take_node(std::vector<std::uint32_t>& starting) {
        for (const std::uint64_t here = nodes_[next_].first; next_ < nodes_.size() && nodes_[next_].first == here; ++next_) {
            if (nodes_[next_].second % 2 == 0) starting.push_back(nodes_[next_].second / 2);
        }
    }

    // Those of the line's edges that pass p: from the first to before the second.
    std::pair<std::size_t, std::size_t> passing(const Place& p) const {
        const auto first = std::partition_point(line_.begin(), line_.end(), [&](std::uint32_t e) { return side(spans_[e], p) > 0; });
        auto last = first;
        while (last != line_.end() && side(spans_[*last], p) == 0) ++last;
        return {std::size_t(first - line_.begin()), std::size_t(last - line_.begin())};
    }

    std::vector<std::uint32_t>& line() { return line_; }

    // Puts others in the place of some.
    void replace(std::size_t first, std::size_t last, const std::vector<std::uint32_t>& others) {
        const std::size_t shared = std::min(last - first, others.size());
        std::copy_n(others.begin(), shared, line_.begin() + std::ptrdiff_t(first));
        if (shared < last - first) {
            line_.erase(line_.begin() + std::ptrdiff_t(first + shared), line_.begin() + std::ptrdiff_t(last));
        } else {
            line_.insert(line_.begin() + std::ptrdiff_t(last), others.begin() + std::ptrdiff_t(shared), others.end());
        }
    }

    // From below to above, beyond a place that all pass.
    void order(std::vector<std::uint32_t>& edges) const {
        std::sort(edges.begin(), edges.end(), [&](std::uint32_t e, std::uint32_t f) {
            return below_beyond(spans_[e], spans_[f]) || (!below_beyond(spans_[f], spans_[e]) && e < f);
        });
    }

private:
    static std::uint64_t key(GridNode p) { return std::uint64_t(p.x) << 32 | std::uint64_t(p.y); }

    std::vector<Span> spans_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> nodes_;
    std::size_t next_ = 0;
    std::vector<std::uint32_t> line_;
};

template <class Edges>
std::vector<Span> spans_of(const Edges& edges) {
    std::vector<Span> spans;
    spans.reserve(edges.size());
    for (const auto& e : edges) spans.push_back({std::min(e.a, e.b), std::max(e.a, e.b)});
    return spans;
}

// Each split once, along its edge.
std::size_t put_in_order(const std::vector<GridEdge>& edges, std::vector<std::vector<GridNode>>& splits) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (splits[i].empty()) continue;
        const GridEdge& e = edges[i];
        const auto along = [&](GridNode p) { return (p.x - e.a.x) * (e.b.x - e.a.x) + (p.y - e.a.y) * (e.b.y - e.a.y); };
        std::sort(splits[i].begin(), splits[i].end(), [&](GridNode p, GridNode q) { return std::pair(along(p), p) < std::pair(along(q), q); });
        splits[i].erase(std::unique(splits[i].begin(), splits[i].end()), splits[i].end());
        count += splits[i].size();
    }
    return count;
}

}  // namespace

bool find_splits(const std::vector<GridEdge>& edges, std::size_t most, std::vector<std::vector<GridNode>>& splits, std::size_t& count, CrossingWork& work) {
    splits.assign(edges.size(), {});
    count = 0;
    Sweep sweep(spans_of(edges));
    std::priority_queue<Place, std::vector<Place>, Later> crossings;
    const auto split = [&](std::size_t i, GridNode p) {
        if (p == edges[i].a || p == edges[i].b || (!splits[i].empty() && splits[i].back() == p)) return;
        splits[i].push_back(p);
        ++count;
    };
    const auto paid = [&](std::size_t cost) {
        const bool enough = cost <= work.left;
        work.left -= std::min(cost, work.left);
        return enough;
    };
    std::vector<std::uint32_t> beyond;
    std::size_t bound = most;  // of splits that may be there more than once
    while (!sweep.at_end() || !crossings.empty()) {
        Place p;
        bool at_node = false;
        if (crossings.empty() || (!sweep.at_end() && compare(sweep.next_node(), crossings.top()) <= 0)) {
            p = sweep.next_node();
            at_node = true;
        } else {
            p = crossings.top();
        }
        while (!crossings.empty() && compare(crossings.top(), p) == 0) {
            crossings.pop();
            if (!paid(1)) return false;
        }
        // First those that go on beyond it, then also those that start there.
        beyond.clear();
        const auto [first, last] = sweep.passing(p);
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t e = sweep.line()[i];
            if (sweep.span(e).high != GridNode{p.x, p.y} || p.den != 1) beyond.push_back(e);
        }
        if (at_node) {
            for (const std::uint32_t e : beyond) split(e, {p.x, p.y});
        }
        if (beyond.size() > 1) {
            if (!paid(beyond.size() * (beyond.size() - 1) / 2)) return false;
            for (std::size_t m = 0; m < beyond.size(); ++m) {
                for (std::size_t n = m + 1; n < beyond.size(); ++n) {
                    const auto [i, j] = std::minmax(beyond[m], beyond[n]);
                    if (!cross(sweep.span(i), sweep.span(j))) continue;  // one lies on the other
                    const GridNode node = crossing_node(edges[i], edges[j]);
                    split(i, node);
                    split(j, node);
                }
            }
        }
        if (count > bound) {
            count = put_in_order(edges, splits);
            if (count > most) return false;
            bound = count + most / 4;
        }
        if (at_node) sweep.take_node(beyond);
        sweep.order(beyond);
        sweep.replace(first, last, beyond);
        const std::vector<std::uint32_t>& line = sweep.line();
        const auto ask = [&](std::size_t above) {
            if (above == 0 || above >= line.size()) return;
            const Span &e = sweep.span(line[above - 1]), &f = sweep.span(line[above]);
            if (!cross(e, f)) return;
            const Place place = crossing_place(e, f);
            if (compare(place, p) > 0) crossings.push(place);
        };
        ask(first);
        if (!beyond.empty()) ask(first + beyond.size());
    }
    count = put_in_order(edges, splits);
    return count <= most;
}

std::vector<int> windings_on_the_right(const std::vector<NetEdge>& edges) {
    std::vector<int> right(edges.size(), 0);
    Sweep sweep(spans_of(edges));
    std::vector<std::uint32_t> starting;
    while (!sweep.at_end()) {
        const Place p = sweep.next_node();
        starting.clear();
        const auto [first, last] = sweep.passing(p);
        sweep.take_node(starting);
        sweep.order(starting);
        int winding = 0;
        if (first > 0) {
            const std::uint32_t under = sweep.line()[first - 1];
            winding = right[under] + edges[under].times;
        }
        for (const std::uint32_t e : starting) {
            right[e] = winding;
            winding += edges[e].times;
        }
        sweep.replace(first, last, starting);
    }
    return right;
}

std::vector<int> windings_by_rays(const std::vector<NetEdge>& edges) {
    std::vector<int> right;
    right.reserve(edges.size());
    for (const NetEdge& e : edges) {
        // Coordinates are doubled, so that the middle is on the grid. A ray to the right of it, of one along x upwards.
        const GridNode middle{e.a.x + e.b.x, e.a.y + e.b.y};
        const bool level = e.a.y == e.b.y;
        int winding = 0;
        for (const NetEdge& f : edges) {
            const GridNode a{2 * f.a.x, 2 * f.a.y}, b{2 * f.b.x, 2 * f.b.y};
            const bool rises = level ? a.x <= middle.x : a.y <= middle.y;
            if (&f == &e || rises == (level ? b.x <= middle.x : b.y <= middle.y)) continue;
            const std::int64_t left = level ? -side_of(a, b, middle) : side_of(a, b, middle);
            if ((left > 0) == rises) winding += rises ? f.times : -f.times;
        }
        // Beyond a rising edge is its right, beyond one to the right or a falling one its left.
        if (level) {
            right.push_back(-winding - e.times);
        } else {
            right.push_back(e.b.y > e.a.y ? winding : winding - e.times);
        }
    }
    return right;
}

}  // namespace penumbra
