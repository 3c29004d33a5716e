// SPDX-License-Identifier: MIT
// How much of the renderers' time a client may have: so many milliseconds a minute, which come back as the minute passes.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

namespace penumbra {

class ClientBudgets {
public:
    // 0: no bound.
    explicit ClientBudgets(double ms_a_minute) : most_(ms_a_minute) {}

    bool limited() const { return most_ > 0; }
    double most_ms() const { return most_; }

    // Takes what a render is expected to cost; false: not so much is left, nothing is taken. One that has all it can have may
    // always take, even more than that: else dear renders could never be made.
    bool take(const std::string& client, double ms);
    // What it cost beyond that (or less, when negative).
    void settle(const std::string& client, double more_ms);

    struct State {
        double most_ms = 0, left_ms = 0;
        double full_in_s = 0;  // when all of it is there again
    };
    State state(const std::string& client) const;
    double seconds_until(const std::string& client, double ms) const;  // so much is there

private:
    using Clock = std::chrono::steady_clock;
    struct Account {
        double left = 0;
        Clock::time_point at;
    };
    double left_locked(const std::string& client, Clock::time_point now) const;

    const double most_;
    mutable std::mutex mutex_;
    std::unordered_map<std::string, Account> accounts_;  // of those who have not all of it
};

}  // namespace penumbra
