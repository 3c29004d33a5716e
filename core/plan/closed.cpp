// SPDX-License-Identifier: MIT
#include "core/plan/closed.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/plan/corners.h"

namespace penumbra {
namespace {

using reference::Boundary;
using reference::Piece;

constexpr int kAmbiguous = -1;
constexpr double kMargin = 2;  // px

// Points along a piece, its end left out: arcs bend by at most 9 degrees between two.
void add_points(const Piece& piece, const PixelFrame& frame, std::vector<glm::dvec2>& ring) {
    const int parts = piece.is_arc ? std::max(1, static_cast<int>(std::ceil((piece.t1 - piece.t0) / (std::numbers::pi / 20)))) : 1;
    ring.push_back(frame.point(piece.a));
    for (int i = 1; i < parts; ++i) ring.push_back(frame.point(piece.at(piece.t0 + (piece.t1 - piece.t0) * i / parts)));
}

double twice_area(const std::vector<glm::dvec2>& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum;
}

// How often the ring goes around the point.
int winding(const std::vector<glm::dvec2>& ring, glm::dvec2 p) {
    int turns = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i] - p, b = ring[(i + 1) % ring.size()] - p;
        const double side = a.x * b.y - a.y * b.x;
        if (a.y <= 0 && b.y > 0 && side > 0) ++turns;
        if (a.y > 0 && b.y <= 0 && side < 0) --turns;
    }
    return turns;
}

glm::dvec2 middle_of(const Piece& piece, const PixelFrame& frame) {
    return frame.point(piece.is_arc || piece.is_full ? piece.at(0.5 * (piece.t0 + piece.t1)) : 0.5 * (piece.a + piece.b));
}

// Rings of pieces, end to start. Where two go on from one corner, which one is anybody's guess: no ring goes through.
std::vector<std::vector<std::size_t>> rings_of(const Boundary& boundary, const PixelFrame& frame) {
    const std::vector<Piece>& pieces = boundary.pieces();
    Corners corners(frame);
    const auto key = [&](Point p) {
        const glm::vec2 at = corners.at(p);
        return std::pair(at.x, at.y);
    };
    std::map<std::pair<float, float>, int> starts;
    std::vector<std::pair<float, float>> ends(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].is_full) continue;
        const auto [place, fresh] = starts.emplace(key(pieces[i].a), static_cast<int>(i));
        if (!fresh) place->second = kAmbiguous;
        ends[i] = key(pieces[i].b);
    }
    std::vector<std::vector<std::size_t>> rings;
    std::vector<bool> seen(pieces.size(), false);
    for (std::size_t first = 0; first < pieces.size(); ++first) {
        if (seen[first] || pieces[first].is_full) continue;
        std::vector<std::size_t> ring;
        std::size_t at = first;
        while (!seen[at]) {
            seen[at] = true;
            ring.push_back(at);
            const auto next = starts.find(ends[at]);
            if (next == starts.end() || next->second == kAmbiguous) {
                ring.clear();
                break;
            }
            at = static_cast<std::size_t>(next->second);
        }
        if (!ring.empty() && at == first) rings.push_back(std::move(ring));
    }
    return rings;
}

}  // namespace

std::vector<DarkRegion> dark_regions(const Boundary& boundary, const PixelFrame& frame, std::size_t most_pieces) {
    const std::vector<Piece>& pieces = boundary.pieces();
    std::vector<DarkRegion> regions;
    if (pieces.size() > most_pieces) return regions;
    const auto shines = [&](std::size_t i) {
        const reference::Material& material = boundary.material_of(pieces[i]);
        return material.emission != Colour(0) || material.slope != Colour(0);
    };
    std::optional<std::vector<glm::dvec2>> lights;  // a point on each piece that shines
    for (const std::vector<std::size_t>& ring : rings_of(boundary, frame)) {
        if (std::any_of(ring.begin(), ring.end(), shines)) continue;
        DarkRegion region;
        for (const std::size_t i : ring) add_points(pieces[i], frame, region.ring);
        // Solid is on the left: a ring about free space goes round the other way.
        if (twice_area(region.ring) >= 0) continue;
        if (!lights) {
            lights.emplace();
            for (std::size_t i = 0; i < pieces.size(); ++i)
                if (shines(i)) lights->push_back(middle_of(pieces[i], frame));
        }
        if (std::none_of(lights->begin(), lights->end(), [&](glm::dvec2 p) { return winding(region.ring, p) != 0; }))
            regions.push_back(std::move(region));
    }
    return regions;
}

std::vector<glm::ivec2> tiles_within(const std::vector<DarkRegion>& regions, glm::ivec2 canvas, int tile) {
    const glm::ivec2 tiles{(canvas.x + tile - 1) / tile, (canvas.y + tile - 1) / tile};
    const auto tile_of = [&](double v, int last) { return static_cast<int>(std::clamp(std::floor(v / tile), 0.0, double(last))); };
    std::vector<bool> within(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y), false);
    std::vector<int> touched(within.size(), -1);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const std::vector<glm::dvec2>& ring = regions[r].ring;
        glm::dvec2 low = ring.front(), high = ring.front();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
            low = {std::min(low.x, a.x), std::min(low.y, a.y)};
            high = {std::max(high.x, a.x), std::max(high.y, a.y)};
            // All tiles that a step of at most a tile's length may come near.
            const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(b.x - a.x, b.y - a.y) / tile)));
            if (steps > 4 * (tiles.x + tiles.y) + 64) return {};  // far beyond the canvas
            for (int s = 0; s < steps; ++s) {
                const glm::dvec2 p = a + (b - a) * (double(s) / steps), q = a + (b - a) * (double(s + 1) / steps);
                if (std::max(p.x, q.x) < -kMargin || std::max(p.y, q.y) < -kMargin || std::min(p.x, q.x) > canvas.x + kMargin ||
                    std::min(p.y, q.y) > canvas.y + kMargin)
                    continue;
                for (int y = tile_of(std::min(p.y, q.y) - kMargin, tiles.y - 1); y <= tile_of(std::max(p.y, q.y) + kMargin, tiles.y - 1); ++y)
                    for (int x = tile_of(std::min(p.x, q.x) - kMargin, tiles.x - 1); x <= tile_of(std::max(p.x, q.x) + kMargin, tiles.x - 1); ++x)
                        touched[static_cast<std::size_t>(y * tiles.x + x)] = static_cast<int>(r);
            }
        }
        if (high.x < 0 || high.y < 0 || low.x > canvas.x || low.y > canvas.y) continue;
        for (int y = tile_of(low.y, tiles.y - 1); y <= tile_of(high.y, tiles.y - 1); ++y)
            for (int x = tile_of(low.x, tiles.x - 1); x <= tile_of(high.x, tiles.x - 1); ++x) {
                const auto i = static_cast<std::size_t>(y * tiles.x + x);
                if (touched[i] == static_cast<int>(r) || within[i]) continue;
                within[i] = winding(ring, (glm::dvec2(x, y) + 0.5) * double(tile)) != 0;
            }
    }
    std::vector<glm::ivec2> found;
    for (int y = 0; y < tiles.y; ++y)
        for (int x = 0; x < tiles.x; ++x)
            if (within[static_cast<std::size_t>(y * tiles.x + x)]) found.push_back({x * tile, y * tile});
    return found;
}

}  // namespace penumbra
