// SPDX-License-Identifier: MIT
#include "core/reference/boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/reference/intersect.h"

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

struct Cut {
    double t;
    Point point;
};

// Sweeps pieces by their left end and calls visit(i, j) where two boxes meet.
template <class Visit>
void for_each_pair(const std::vector<Box>& boxes, const Visit& visit) {
    std::vector<std::int32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    const auto box = [&](std::int32_t i) -> const Box& { return boxes[std::size_t(i)]; };
    std::sort(order.begin(), order.end(),
              [&](auto i, auto j) { return box(i).low.x < box(j).low.x; });
    std::vector<std::int32_t> open;
    for (const std::int32_t i : order) {
        std::size_t kept = 0;
        for (const std::int32_t j : open) {
            if (box(j).high.x < box(i).low.x) continue;
            open[kept++] = j;
            if (box(i).meets(box(j))) visit(std::size_t(j), std::size_t(i));
        }
        open.resize(kept);
        open.push_back(i);
    }
}

// The part of `whole` between two cuts.
Piece part_of(const Piece& whole, const Cut& from, const Cut& to) {
    Piece part = whole;
    part.is_full = false;
    part.a = from.point;
    part.b = to.point;
    if (whole.is_arc) {
        part.t0 = from.t;
        part.t1 = to.t;
        part.e0 = {std::cos(from.t), std::sin(from.t)};
        part.e1 = {std::cos(to.t), std::sin(to.t)};
    }
    return part;
}

}  // namespace

Boundary::Boundary(const Scene& scene, std::size_t max_pieces, bool open_rings)
    : open_rings_(open_rings) {
    const ViewRect view = scene.canvas.view_or_default();
    const double margin = scene.canvas.margin;
    domain_.add({view.x - margin, view.y - margin});
    domain_.add({view.x + view.w + margin, view.y + view.h + margin});
    // A fifty-billionth of the domain, yet well above the rounding of coordinates far from zero.
    const Point size = domain_.high - domain_.low;
    const double far = std::max({std::abs(domain_.low.x), std::abs(domain_.low.y),
                                 std::abs(domain_.high.x), std::abs(domain_.high.y)});
    tolerance_ = std::max(2e-11 * std::max(size.x, size.y), 2e-14 * far);

    Outlines outlines = outlines_of(scene, max_pieces);
    problems_ = std::move(outlines.problems);
    bodies_ = std::move(outlines.bodies);
    materials_ = std::move(outlines.materials);
    if (!problems_.empty()) return;
    index_bodies();
    split_and_keep(outlines.pieces);
}

void Boundary::index_bodies() {
    grid_ = domain_.grown(0.01 *
                          std::max(domain_.high.x - domain_.low.x, domain_.high.y - domain_.low.y));
    const int side = std::clamp(int(std::sqrt(double(bodies_.size()) * 4)), 1, 256);
    cells_x_ = cells_y_ = side;
    cells_.assign(std::size_t(side) * std::size_t(side), {});
    const Point scale = Point(side) / (grid_.high - grid_.low);
    for (std::size_t i = bodies_.size(); i-- > 0;) {
        const Box box = bodies_[i].box.grown(10 * tolerance_);
        if (!box.meets(grid_)) continue;
        const auto cell = [&](double at, double low, double k) {
            return int(std::clamp((at - low) * k, 0.0, double(side - 1)));
        };
        for (int y = cell(box.low.y, grid_.low.y, scale.y);
             y <= cell(box.high.y, grid_.low.y, scale.y); ++y) {
            for (int x = cell(box.low.x, grid_.low.x, scale.x);
                 x <= cell(box.high.x, grid_.low.x, scale.x); ++x) {
                cells_[std::size_t(y) * std::size_t(side) + std::size_t(x)].push_back(
                    std::int32_t(i));
            }
        }
    }
}

int Boundary::topmost(Point p) const {
    const Point q = (p - grid_.low) / (grid_.high - grid_.low) * Point(cells_x_, cells_y_);
    if (!(q.x >= 0 && q.y >= 0 && q.x < cells_x_ && q.y < cells_y_)) return -1;
    for (const std::int32_t i :
         cells_[std::size_t(q.y) * std::size_t(cells_x_) + std::size_t(q.x)]) {
        if (bodies_[std::size_t(i)].contains(p)) return i;
    }
    return -1;
}

void Boundary::split_and_keep(const std::vector<Piece>& raw) {
    const std::size_t count = raw.size();
    std::vector<Box> boxes(count);
    std::vector<std::vector<Cut>> cuts(count);
    std::vector<Meeting> meetings;
    const Box& d = domain_;
    const Piece border[4] = {
        straight_piece(d.low, {d.high.x, d.low.y}), straight_piece({d.high.x, d.low.y}, d.high),
        straight_piece(d.high, {d.low.x, d.high.y}), straight_piece({d.low.x, d.high.y}, d.low)};
    for (std::size_t i = 0; i < count; ++i) {
        boxes[i] = raw[i].box().grown(2 * tolerance_);
        for (const Piece& side : border) {
            if (!boxes[i].meets(side.box().grown(2 * tolerance_))) continue;
            meetings.clear();
            find_meetings(raw[i], side, tolerance_, meetings);
            for (const Meeting& m : meetings) cuts[i].push_back({m.t_first, m.point});
        }
    }
    for_each_pair(boxes, [&](std::size_t i, std::size_t j) {
        // Pieces of one convex body meet only at their ends; a polygon's edges may cross.
        if (raw[i].body == raw[j].body &&
            bodies_[std::size_t(raw[i].body)].kind != Body::Kind::polygon)
            return;
        meetings.clear();
        find_meetings(raw[i], raw[j], tolerance_, meetings);
        for (const Meeting& m : meetings) {
            cuts[i].push_back({m.t_first, m.point});
            cuts[j].push_back({m.t_second, m.point});
        }
    });
    for (std::size_t i = 0; i < count; ++i) {
        const Piece& whole = raw[i];
        std::vector<Cut>& own = cuts[i];
        if (!boxes[i].meets(domain_)) continue;
        if (whole.is_full) {
            if (own.empty() && !open_rings_) {
                keep_if_visible(whole);
                continue;
            }
            if (own.empty()) own.push_back({whole.t0, whole.a});
            // Cut the ring open at its first cut.
            std::sort(own.begin(), own.end(), [](const Cut& x, const Cut& y) { return x.t < y.t; });
            own.push_back({own.front().t + 2 * kPi, own.front().point});
        } else {
            std::erase_if(own, [&](const Cut& c) { return c.t <= whole.t0 || c.t >= whole.t1; });
            own.push_back({whole.t0, whole.a});
            own.push_back({whole.t1, whole.b});
            std::sort(own.begin(), own.end(), [](const Cut& x, const Cut& y) { return x.t < y.t; });
        }
        for (std::size_t k = 0; k + 1 < own.size(); ++k) {
            Cut from = own[k];
            const Cut to = own[k + 1];
            if (to.t <= from.t ||
                length_squared(to.point - from.point) <= tolerance_ * tolerance_) {
                // One point found twice (or a whole turn between equal points: told by its length).
                if (!whole.is_arc || to.t - from.t < 1) continue;
            }
            // Arcs of less than half a turn keep the sweep's case distinctions simple.
            const int parts =
                whole.is_arc ? std::max(1, int(std::ceil((to.t - from.t) / (0.55 * kPi)))) : 1;
            const double step = (to.t - from.t) / parts;
            for (int n = 1; n <= parts; ++n) {
                Cut next = to;
                if (n < parts) {
                    const double t = own[k].t + n * step;
                    next = {t, whole.center + whole.u * std::cos(t) + whole.v * std::sin(t)};
                }
                keep_if_visible(part_of(whole, from, next));
                from = next;
            }
        }
    }
}

void Boundary::keep_if_visible(Piece part) {
    const double middle = 0.5 * (part.t0 + part.t1);
    const Point m = part.at(middle);
    if (!domain_.grown(tolerance_).contains(m) && !part.is_full) return;
    if (part.is_full && !domain_.grown(tolerance_).contains(part.a)) return;
    Point normal = turned(part.tangent(middle));
    normal /= std::sqrt(length_squared(normal));
    const Point step = normal * (4 * tolerance_);
    const int outside = topmost(m + step);
    const int inside = topmost(m - step);
    if ((outside >= 0) == (inside >= 0)) return;  // both sides solid, or an edge that cancels out
    int top = inside;
    if (inside < 0) {
        std::swap(part.a, part.b);  // only straight edges of polygons come the wrong way round
        top = outside;
    }
    // Where outlines coincide the topmost body counts. A bitmap has pieces of its own there.
    if (top != part.body) {
        const Body& body = bodies_[std::size_t(top)];
        if (body.kind == Body::Kind::bitmap) return;
        part.material = body.material_at(m);
        part.body = top;
    }
    pieces_.push_back(part);
}

}  // namespace penumbra::reference
