// SPDX-License-Identifier: MIT
// A scene as bytes, the same for all texts that mean the same: order of keys, white space, ways to write a number or a colour,
// and values that are the default anyway do not show.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/scene/scene.h"

namespace penumbra {

// Equal exactly when the scenes are. For use within one build: the bytes may be others in the next.
std::string normal_form(const Scene& scene);

// The scene that has this form; nothing when the bytes are none.
std::optional<Scene> read_normal_form(std::string_view bytes);

}  // namespace penumbra
