// SPDX-License-Identifier: MIT
#pragma once

#include "core/scene/problem.h"
#include "core/scene/scene.h"

namespace penumbra {

// What is there only where an operator gave it.
struct Features {
    bool tone_lut = false;  // for the tone map "tony"
};

// Features of the format that this build does not render yet, each a problem with code
// "not_supported_yet" that names its key. Nothing that parses is silently ignored.
Problems unsupported(const Scene& scene, const Features& features = {});

}  // namespace penumbra
