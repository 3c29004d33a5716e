// SPDX-License-Identifier: MIT
#include "core/plan/nearest_free.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace penumbra {
namespace {

constexpr int kNone = std::numeric_limits<int>::max();

}  // namespace

std::vector<glm::ivec2> nearest_free(const std::vector<std::uint8_t>& solid, glm::ivec2 size) {
    const auto at = [&](int x, int y) { return std::size_t(y) * std::size_t(size.x) + std::size_t(x); };
    // The row of the nearest free pixel in the same column.
    std::vector<int> row(solid.size(), kNone);
    for (int x = 0; x < size.x; ++x) {
        int last = kNone;
        for (int y = 0; y < size.y; ++y) {
            if (solid[at(x, y)] == 0) last = y;
            row[at(x, y)] = last;
        }
        last = kNone;
        for (int y = size.y; y-- > 0;) {
            if (solid[at(x, y)] == 0) last = y;
            int& best = row[at(x, y)];
            if (last != kNone && (best == kNone || last - y < y - best)) best = last;
        }
    }
    std::vector<glm::ivec2> out(solid.size());
    std::vector<int> places;     // columns whose parabola is lowest somewhere
    std::vector<double> begins;  // from where on
    for (int y = 0; y < size.y; ++y) {
        places.clear();
        begins.clear();
        const auto height = [&](int x) {
            const double up = double(row[at(x, y)]) - y;
            return up * up;
        };
        for (int x = 0; x < size.x; ++x) {
            if (row[at(x, y)] == kNone) continue;
            double begin = -std::numeric_limits<double>::infinity();
            while (!places.empty()) {
                const int before = places.back();
                begin = (height(x) + double(x) * x - height(before) - double(before) * before) / (2.0 * (x - before));
                if (begin > begins.back()) break;
                places.pop_back();
                begins.pop_back();
                begin = -std::numeric_limits<double>::infinity();
            }
            places.push_back(x);
            begins.push_back(begin);
        }
        if (places.empty()) return {};
        std::size_t k = 0;
        for (int x = 0; x < size.x; ++x) {
            while (k + 1 < places.size() && begins[k + 1] < x) ++k;
            out[at(x, y)] = {places[k], row[at(places[k], y)]};
        }
    }
    return out;
}

}  // namespace penumbra
