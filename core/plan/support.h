// SPDX-License-Identifier: MIT
#pragma once

#include "core/scene/problem.h"
#include "core/scene/scene.h"

namespace penumbra {

// Features of the format that this build does not render yet, each a problem with code
// "not_supported_yet" that names its key. Nothing that parses is silently ignored.
Problems unsupported(const Scene& scene);

}  // namespace penumbra
