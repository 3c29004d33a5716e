// SPDX-License-Identifier: MIT
// Text in, Scene out, or every problem at once with its place in the text.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/limits.h"
#include "core/scene/problem.h"
#include "core/scene/scene.h"
#include "server/json/font_source.h"

namespace penumbra {

struct LocatedProblem {
    Problem problem;
    int line = 0;            // 1-based, in the text as sent; 0 when the place is not in the text
    int column = 0;          // 1-based, in bytes
    std::string suggestion;  // nearest known key or value, "" when there is none
    std::string set_at{};    // pointer of the override that wrote the value, "" when the text did
};

// Limits on the text itself, enforced before any tree exists.
struct TextLimits {
    std::size_t max_bytes = 64u << 20;     // a body; mostly bitmaps
    int max_depth = 32;                    // the format needs 7
    std::size_t max_nodes = 2'000'000;     // values of any kind
    std::size_t max_string_bytes = 64u << 20;
    std::size_t max_problems = 100;        // reported; the rest are counted
};

// Replaces (or adds) the value at a JSON pointer before the scene is built: `--set`.
struct Override {
    std::string pointer;  // "/canvas/width", "/shapes/0/radius", "/shapes/-" appends
    std::string value;    // JSON text; text that is not JSON is taken as a string
};

struct ParsedScene {
    std::optional<Scene> scene;  // set exactly when `problems` is empty
    std::vector<LocatedProblem> problems;
    std::size_t problems_left_out = 0;
    bool is_json = true;  // false when the text is not JSON at all (HTTP 400, else 422)
};

// Parses, builds, validates (core/scene/validate.h). Collects as many problems as it can in one go:
// unknown keys (with the nearest known one), wrong types, missing keys, bad pictures, ranges, limits.
ParsedScene parse_scene(std::string_view text, const Limits& limits = {}, const TextLimits& text_limits = {},
                        const std::vector<Override>& overrides = {}, const FontSource& fonts = FontSource());

// One line for a terminal: "/shapes/3/radius (line 12, column 40): must be more than 0, is -1"; with
// "(--set /shapes/3/radius)" as the place of what an override wrote.
std::string to_string(const LocatedProblem& problem);

// Locates problems found after parsing (validation by others, unsupported features) in the text with
// its overrides.
std::vector<LocatedProblem> locate(std::string_view text, const Problems& problems,
                                   const std::vector<Override>& overrides = {});

}  // namespace penumbra
