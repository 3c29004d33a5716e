// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace penumbra {

// llvmpipe counts processors by affinity alone: in a container with two of 64 processors it starts 32
// threads that fight for two. Sets LP_NUM_THREADS from the control group's quota unless it is set.
// Called before any thread exists.
void limit_render_threads_to_cpu_quota();

// How many processors this process may use: by affinity and by the quota, whichever is fewer; at least 1.
int usable_processors();

// Whole processors in a cgroup v2 cpu.max ("200000 100000" is 2, rounded up); 0: no quota.
int processors_of_cpu_max(std::string_view text);

}  // namespace penumbra
