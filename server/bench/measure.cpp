// SPDX-License-Identifier: MIT
#include "server/bench/measure.h"

#include <algorithm>
#include <ctime>
#include <stdexcept>

namespace penumbra {

double process_cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * double(now.tv_sec) + 1e-6 * double(now.tv_nsec);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Work work_of(const RenderStats& stats) {
    Work work;
    for (const PassStats& pass : stats.passes) {
        work.rays += pass.rays;
        work.points += pass.points;
        work.dispatches += pass.dispatches;
        if (pass.dispatches > 0) work.invocations += std::uint64_t(pass.width) * std::uint64_t(pass.height);
    }
    return work;
}

Scene bench_scene(const std::string& path, const std::string& text, const std::vector<Override>& overrides) {
    ParsedScene parsed = parse_scene(text, {}, {}, overrides);
    if (!parsed.scene) {
        LocatedProblem& problem = parsed.problems.front();
        problem.set_at.clear();  // the overrides are bench's own, nobody wrote --set
        throw std::runtime_error(path + ": " + to_string(problem));
    }
    return std::move(*parsed.scene);
}

}  // namespace penumbra
