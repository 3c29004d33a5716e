// SPDX-License-Identifier: MIT
// A scene as the text that docs/scene-format.md describes, so that one that fails can be kept.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace penumbra::test {

std::string scene_text(const Scene& scene);

}  // namespace penumbra::test
