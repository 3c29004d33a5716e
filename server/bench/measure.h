// SPDX-License-Identifier: MIT
// What every benchmark measures by.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/render_stats.h"
#include "core/scene/scene.h"
#include "server/json/scene_json.h"

namespace penumbra {

// Processor time of all threads of this process.
double process_cpu_ms();

double median(std::vector<double> values);

// What a render did, whatever the machine.
struct Work {
    std::uint64_t rays = 0, points = 0, dispatches = 0, invocations = 0;
    bool operator==(const Work&) const = default;
};
Work work_of(const RenderStats& stats);

// Throws std::runtime_error with the first problem.
Scene bench_scene(const std::string& path, const std::string& text, const std::vector<Override>& overrides);

}  // namespace penumbra
