// SPDX-License-Identifier: MIT
#include "core/plan/nearest_free.h"

#include <gtest/gtest.h>

#include "tests/support/build_scene.h"

namespace penumbra::test {
namespace {

int squared(glm::ivec2 d) { return d.x * d.x + d.y * d.y; }

TEST(NearestFree, AsByTryingAll) {
    Numbers numbers(3);
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {7, 1}, {1, 9}, {23, 17}, {40, 31}})
        for (const double share : {0.0, 0.3, 0.9, 0.99}) {
            std::vector<std::uint8_t> solid(std::size_t(size.x * size.y));
            for (std::uint8_t& s : solid) s = numbers.next() < share ? 1 : 0;
            const auto found = nearest_free(solid, size);
            int best_of_all = 0;
            for (const std::uint8_t s : solid) best_of_all += s == 0;
            if (best_of_all == 0) {
                EXPECT_TRUE(found.empty());
                continue;
            }
            ASSERT_EQ(found.size(), solid.size());
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    int best = 1 << 30;
                    for (int v = 0; v < size.y; ++v)
                        for (int u = 0; u < size.x; ++u)
                            if (solid[std::size_t(v * size.x + u)] == 0) best = std::min(best, squared({u - x, v - y}));
                    const glm::ivec2 at = found[std::size_t(y * size.x + x)];
                    EXPECT_EQ(solid[std::size_t(at.y * size.x + at.x)], 0);
                    EXPECT_EQ(squared(at - glm::ivec2(x, y)), best) << x << " " << y;
                }
        }
}

TEST(NearestFree, NothingWhereAllIsSolid) { EXPECT_TRUE(nearest_free({1, 1, 1, 1}, {2, 2}).empty()); }

}  // namespace
}  // namespace penumbra::test
