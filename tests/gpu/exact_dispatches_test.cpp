// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "core/passes/exact_band.h"

namespace penumbra {
namespace {

// As exact_solve.comp goes on: a dispatch begins a list when what is left suffices for the most that it can take, and always one.
int dispatches_of(const std::vector<std::int64_t>& lists, std::int64_t budget) {
    int dispatches = 1;
    std::int64_t left = budget;
    for (const std::int64_t work : lists) {
        if (work > left && left < budget) {
            ++dispatches;
            left = budget;
        }
        left -= work;
    }
    return dispatches;
}

TEST(ExactDispatches, FinishAnyLists) {
    std::mt19937 random(7);
    for (int i = 0; i < 5000; ++i) {
        const int sectors = std::uniform_int_distribution(1, 64)(random);
        const std::int64_t longest = std::uniform_int_distribution(1, 2 * static_cast<int>(kMostWork))(random);
        std::vector<std::int64_t> lists(static_cast<std::size_t>(sectors));
        for (std::int64_t& work : lists) work = i % 2 == 0 ? longest : std::uniform_int_distribution<std::int64_t>(0, longest)(random);
        EXPECT_LE(dispatches_of(lists, kMostWork), solver_dispatches(longest, sectors, kMostWork)) << longest << " x " << sectors;
    }
}

TEST(ExactDispatches, OfShortListsIsOne) {
    EXPECT_EQ(solver_dispatches(900, 32, kMostWork), 1);
    EXPECT_EQ(solver_dispatches(15'000, 64, kMostWorkOfLongLoops), 1);
    EXPECT_EQ(solver_dispatches(kMostWork + 1, 32, kMostWork), 32);
}

}  // namespace
}  // namespace penumbra
