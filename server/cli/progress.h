// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace penumbra {

// Progress of long work on stderr: one line that is rewritten on a terminal, a line every ten seconds elsewhere.
class Progress {
public:
    explicit Progress(std::string what, bool quiet = false);
    ~Progress();
    void update(double fraction);  // 0 to 1

private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    bool quiet_;
    bool terminal_;
    bool shown_ = false;
    bool started_ = false;       // time counts from the first update
    Clock::time_point start_;
    Clock::time_point last_;
};

}  // namespace penumbra
