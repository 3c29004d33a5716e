// SPDX-License-Identifier: MIT
#pragma once

#include "core/scene/limits.h"
#include "core/scene/scene.h"
#include "server/json/font_source.h"
#include "server/json/json_tree.h"
#include "server/json/problem_list.h"

namespace penumbra {

// The scene that the document describes. What cannot be read is in `problems`, and in the scene as
// NaN, zero or empty, so that validate() leaves out what depends on it.
// Paths and texts come as polygons; `fonts` is what texts are set in.
Scene build_scene(const JsonTree& tree, const Limits& limits, const FontSource& fonts, ProblemList& problems);

}  // namespace penumbra
