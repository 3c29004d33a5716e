// SPDX-License-Identifier: MIT
// Small scenes that between them need the programs that clients' scenes need. A driver compiles a program when it first runs, and
// llvmpipe once more for other kinds of textures: seconds, which no client should wait for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace penumbra {

enum class WarmUp { none, common, all };

struct WarmUpScene {
    std::string name;  // for the log
    Scene scene;
};
std::vector<WarmUpScene> warm_up_scenes(WarmUp extent);

}  // namespace penumbra
