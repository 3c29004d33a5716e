// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "server/json/json_tree.h"
#include "server/json/problem_list.h"
#include "server/json/scene_json.h"

namespace penumbra {

// Puts each override's value into the tree, in their order. The tree views the overrides' texts.
void apply_overrides(JsonTree& tree, const std::vector<Override>& overrides,
                     const TextLimits& limits, ProblemList& problems);

}  // namespace penumbra
