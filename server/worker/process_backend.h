// SPDX-License-Identifier: MIT
// A renderer in a process of its own. What it does to that process (a crash, a hang, memory that grows) it does to one render.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/service/engine.h"

namespace penumbra {

struct WorkerProcessOptions {
    std::string program;                                           // this one
    std::vector<std::string> arguments;                            // before those that name the two descriptors
    std::vector<std::pair<std::string, std::string>> environment;  // beyond this process's own
    std::chrono::milliseconds start_time{120'000};  // for a context; a driver that compiles for the first time takes long
    std::chrono::milliseconds silence{30'000};      // without a pulse it counts as hanging; one dispatch may take seconds
    std::chrono::milliseconds stop_time{2'000};     // from being told to stop to being killed
    std::size_t most_memory_bytes = 0;              // beyond it another one takes its place; 0: no bound
    std::uint64_t most_renders = 0;                 // the same
};

// Throws DeviceError when it does not start.
std::unique_ptr<RenderBackend> make_process_backend(const WorkerProcessOptions& options);

}  // namespace penumbra
