// SPDX-License-Identifier: MIT
#include "server/cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace penumbra {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    if (shown_ && terminal_) std::fputs("\n", stderr);
}

void Progress::update(double fraction) {
    if (quiet_) return;
    const Clock::time_point now = Clock::now();
    if (!started_) {
        started_ = true;
        start_ = last_ = now;
    }
    const double since = std::chrono::duration<double>(now - last_).count();
    if (since < (terminal_ ? 0.2 : 10.0)) return;
    last_ = now;
    shown_ = true;
    const double spent = std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "%s%s: %.0f %%", terminal_ ? "\r" : "", what_.c_str(), 100 * fraction);
    if (fraction > 0.01) std::fprintf(stderr, ", about %.0f s left ", spent * (1 - fraction) / fraction);
    if (!terminal_) std::fputs("\n", stderr);
    std::fflush(stderr);
}

}  // namespace penumbra
