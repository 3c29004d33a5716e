// SPDX-License-Identifier: MIT
#include "server/cli/cpu_quota.h"

#include <sched.h>

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

void limit_render_threads_to_cpu_quota() {
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    std::string line;
    if (!std::getline(file, line)) return;
    const int quota = processors_of_cpu_max(line);
    cpu_set_t set;
    CPU_ZERO(&set);
    if (quota <= 0 || ::sched_getaffinity(0, sizeof set, &set) != 0) return;
    if (quota < CPU_COUNT(&set)) ::setenv("LP_NUM_THREADS", std::to_string(quota).c_str(), 0);
}

}  // namespace penumbra
