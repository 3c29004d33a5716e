// SPDX-License-Identifier: MIT
// What each kind of work that a render may leave out saves: the same scene with and without, in turns.
#pragma once

#include <string>
#include <vector>

#include "server/service/engine.h"

namespace penumbra {

struct SkipTableSettings {
    int repeats = 5;
    double most_seconds = 20;  // of one pair; three turns are always made
};

// Rows of a Markdown table for one scene and method: everything left out against nothing, then each kind that this scene has
// against all others. Throws std::runtime_error.
std::string skip_rows(const std::string& scene, const std::string& method, const std::string& quality,
                      const SkipTableSettings& settings, RenderBackend& backend, const Engine& engine);

std::string skip_table_head();

}  // namespace penumbra
