// SPDX-License-Identifier: MIT
#include "server/cli/cpu_quota.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace penumbra {

int processors_of_cpu_max(std::string_view text) {
    std::istringstream stream{std::string(text)};
    double quota = 0, period = 0;
    if (!(stream >> quota >> period) || quota <= 0 || period <= 0) return 0;  // "max 100000"
    return int(std::ceil(quota / period));
}

namespace {

int processors_by_affinity() {
    cpu_set_t set;
    CPU_ZERO(&set);
    return ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

int processors_by_quota() {
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    std::string line;
    return std::getline(file, line) ? processors_of_cpu_max(line) : 0;
}

}  // namespace

int usable_processors() {
    const int quota = processors_by_quota();
    return std::max(quota > 0 ? std::min(quota, processors_by_affinity()) : processors_by_affinity(), 1);
}

void limit_render_threads_to_cpu_quota() {
    const int quota = processors_by_quota();
    if (quota > 0 && quota < processors_by_affinity()) ::setenv("LP_NUM_THREADS", std::to_string(quota).c_str(), 0);
}

}  // namespace penumbra
