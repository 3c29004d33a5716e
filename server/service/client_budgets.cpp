// SPDX-License-Identifier: MIT
#include "server/service/client_budgets.h"

#include <algorithm>

namespace penumbra {
namespace {

// Beyond it those who have all of theirs are forgotten.
constexpr std::size_t kManyAccounts = 10'000;
constexpr double kMinuteS = 60;

}  // namespace

double ClientBudgets::left_locked(const std::string& client, Clock::time_point now) const {
    const auto found = accounts_.find(client);
    if (found == accounts_.end()) return most_;
    const double seconds = std::chrono::duration<double>(now - found->second.at).count();
    return std::min(most_, found->second.left + most_ * seconds / kMinuteS);
}

bool ClientBudgets::take(const std::string& client, double ms) {
    const Clock::time_point now = Clock::now();
    const std::lock_guard lock(mutex_);
    const double left = left_locked(client, now);
    if (left < std::min(ms, most_)) return false;
    if (accounts_.size() >= kManyAccounts) std::erase_if(accounts_, [&](const auto& entry) { return left_locked(entry.first, now) >= most_; });
    accounts_[client] = {left - ms, now};
    return true;
}

void ClientBudgets::settle(const std::string& client, double more_ms) {
    if (!limited()) return;
    const Clock::time_point now = Clock::now();
    const std::lock_guard lock(mutex_);
    accounts_[client] = {left_locked(client, now) - more_ms, now};
}

ClientBudgets::State ClientBudgets::state(const std::string& client) const {
    const std::lock_guard lock(mutex_);
    const double left = left_locked(client, Clock::now());
    return {most_, std::max(left, 0.0), (most_ - left) / most_ * kMinuteS};
}

double ClientBudgets::seconds_until(const std::string& client, double ms) const {
    const std::lock_guard lock(mutex_);
    return std::max(0.0, (std::min(ms, most_) - left_locked(client, Clock::now())) / most_ * kMinuteS);
}

}  // namespace penumbra
