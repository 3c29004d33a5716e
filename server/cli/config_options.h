// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "core/film/tone_lut.h"
#include "server/service/config.h"

namespace CLI {
class App;
}

namespace penumbra {

// The options of `penumbra serve` and their PENUMBRA_* environment variables, into `config`.
// The one place that fills a Config.
void add_config_options(CLI::App& command, Config& config);

// --device alone, with PENUMBRA_DEVICE behind it: shared by the commands that render.
// --font FILE: what texts are set in.
void add_font_option(CLI::App& command, std::string& path);
// --tony-lut FILE: the table of the tone map "tony", which is no part of this program.
void add_tone_lut_option(CLI::App& command, std::string& path);
// Empty for an empty path. Throws InputError when there is no such table.
std::shared_ptr<const ToneLut> read_tone_lut(const std::string& path);

// --token-file and --url-key-file; nothing for an empty path. Throw InputError.
Tokens read_tokens(const std::string& path);
std::string read_key(const std::string& path);

void add_device_option(CLI::App& command, std::string& device);

}  // namespace penumbra
