// SPDX-License-Identifier: MIT
// What a render did, for --stats, Server-Timing and the benchmark.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra {

struct PassStats {
    std::string name;      // "distance", "cascade 3", "compose", "read"
    double gpu_ms = 0;     // device time by timer queries; 0 for passes without device work
    double wall_ms = 0;    // host time, the wait for the device included
    int width = 0;         // extent in invocations
    int height = 0;
    std::uint64_t dispatches = 0;
    std::uint64_t rays = 0;  // rays (intervals) traced
    std::uint64_t bytes = 0; // what it writes
    double cpu_ms = 0;     // processor time of all threads of the process meanwhile
    std::uint64_t points = 0;  // solved by the method `exact`
};

struct SkippedWork {
    std::string what;
    std::string why;
    double saved = 0;  // in units of work named by `what` (invocations unless it says otherwise)
};

struct RenderStats {
    std::string device;
    std::string method;
    std::string method_reason;
    int width = 0;
    int height = 0;
    double total_ms = 0;      // from the scene to the pixels
    std::uint64_t gpu_bytes = 0;
    std::uint64_t lost_rays = 0;  // marches that ran out of steps: taken as blocked
    std::vector<PassStats> passes;
    std::vector<SkippedWork> skipped;
};

}  // namespace penumbra
