// SPDX-License-Identifier: MIT
// What each pass of a frame took.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "core/gl/timer.h"
#include "core/passes/frame.h"
#include "core/render_stats.h"

namespace penumbra {

using Clock = std::chrono::steady_clock;

inline double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Processor time of all threads of this process.
inline double cpu_ms_now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

// Records each pass's time and size while the frame runs. Bands of one pass add up in one record.
class Recorder {
public:
    explicit Recorder(gl::PassTimer& timer) : timer_(timer) { timer_.reset(); }

    template <class Run>
    void pass(const std::string& name, glm::ivec2 extent, Run&& run) {
        const Clock::time_point start = Clock::now();
        const double cpu_start = cpu_ms_now();
        timer_.mark();
        const PassWork work = run();
        timer_.mark();
        gl::check_errors(name.c_str());
        PassStats& stats = add(name, extent, ms_since(start), cpu_ms_now() - cpu_start);
        stats.dispatches += static_cast<std::uint64_t>(work.dispatches);
        stats.rays += work.rays;
        stats.bytes += work.bytes;
        stats.points += work.points;
        marked_.push_back(static_cast<std::size_t>(&stats - passes_.data()));
    }

    template <class Run>
    void host(const std::string& name, glm::ivec2 extent, Run&& run) {
        const Clock::time_point start = Clock::now();
        const double cpu_start = cpu_ms_now();
        run();
        add(name, extent, ms_since(start), cpu_ms_now() - cpu_start);
    }

    std::vector<PassStats> finish() {
        const std::vector<double> device_ms = timer_.read();
        for (std::size_t i = 0; i < marked_.size() && i < device_ms.size(); ++i) passes_[marked_[i]].gpu_ms += device_ms[i];
        return std::move(passes_);
    }

private:
    PassStats& add(const std::string& name, glm::ivec2 extent, double wall_ms, double cpu_ms) {
        auto found = std::find_if(passes_.begin(), passes_.end(), [&](const PassStats& p) { return p.name == name; });
        if (found == passes_.end()) {
            passes_.emplace_back();
            passes_.back().name = name;
            passes_.back().width = extent.x;
            found = passes_.end() - 1;
        }
        found->height += extent.y;
        found->wall_ms += wall_ms;
        found->cpu_ms += cpu_ms;
        return *found;
    }

    gl::PassTimer& timer_;
    std::vector<PassStats> passes_;
    std::vector<std::size_t> marked_;  // the pass of each pair of marks
};

}  // namespace penumbra
