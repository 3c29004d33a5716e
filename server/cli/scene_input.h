// SPDX-License-Identifier: MIT
// The scene that a command is given: a file and --set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/json/scene_json.h"

namespace penumbra {

// "/canvas/width=64" to an override. Throws InputError.
std::vector<Override> parse_sets(const std::vector<std::string>& sets);

// Reads, parses and validates, without asking whether the renderer supports it. Complains on stderr and is empty
// when the scene is not right. Throws InputError when there is no such file.
std::optional<Scene> read_scene(const std::string& path, const std::vector<Override>& overrides);

}  // namespace penumbra
