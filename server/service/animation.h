// SPDX-License-Identifier: MIT
// One text, many pictures: a scene with an `animate` block, which says what of it changes from frame to frame (docs/api.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/json/scene_json.h"

namespace penumbra {

struct AnimationLimits {
    std::size_t max_frames = 600;
    double max_fps = 120;
};

struct Animation {
    std::string scene;  // the text without the block, everything else at its place
    std::vector<std::vector<Override>> frames;
    std::vector<std::string> values;  // of each frame, as JSON: {"/shapes/0/radius": 12}
    double fps = 24;
    int plays = 0;  // of an APNG; 0: for ever
};

struct ParsedAnimation {
    std::optional<Animation> animation;  // set exactly when there are no problems
    std::vector<LocatedProblem> problems;
    bool is_json = true;
};
ParsedAnimation parse_animation(std::string_view text, const TextLimits& limits, const AnimationLimits& animation_limits);

}  // namespace penumbra
