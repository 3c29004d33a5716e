// SPDX-License-Identifier: MIT
// The inside of a worker process: a renderer that does what it is told over a socket.
#pragma once

#include "server/service/engine.h"

namespace penumbra {

// Returns when nobody tells it any more. `socket` and `memory` are what the service left open for it.
int run_worker_process(const Engine& engine, const RendererOptions& options, int socket, int memory);

}  // namespace penumbra
