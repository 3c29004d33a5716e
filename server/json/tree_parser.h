// SPDX-License-Identifier: MIT
// The one door to nlohmann: text to JsonTree in one pass, with the limits enforced on the way.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/json/json_tree.h"
#include "server/json/scene_json.h"

namespace penumbra {

struct TextError {
    std::string code;     // "syntax", "too_large", "too_deep", "too_many"
    std::string message;  // one sentence
    std::size_t offset = 0;
    std::string pointer;  // of the value whose limit was passed, "" else
};

// Appends the document to `tree` (root first) and returns its root, or says why not. The tree views
// `text`, which must outlive it. With `offset` every node gets that one: overrides.
struct ParsedText {
    NodeId root = kNoNode;
    std::optional<TextError> error;
};
ParsedText parse_text(std::string_view text, const TextLimits& limits, JsonTree& tree,
                      std::optional<TextOffset> offset = std::nullopt);

}  // namespace penumbra
