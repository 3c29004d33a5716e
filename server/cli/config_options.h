// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "server/service/config.h"

namespace CLI {
class App;
}

namespace penumbra {

// The options of `penumbra serve` and their PENUMBRA_* environment variables, into `config`.
// The one place that fills a Config.
void add_config_options(CLI::App& command, Config& config);

// --device alone, with PENUMBRA_DEVICE behind it: shared by the commands that render.
void add_device_option(CLI::App& command, std::string& device);

}  // namespace penumbra
