// SPDX-License-Identifier: MIT
// The debug view `error`: how far a method's picture is from the exact solver's, place by place.
#pragma once

#include <string>

#include "core/image/image.h"
#include "core/scene/scene.h"
#include "core/stop.h"

namespace penumbra {

// The scene whose linear picture is compared.
Scene as_compared(const Scene& scene);

// `picture`: of as_compared(scene). Solves some hundred points along each side; what is between them is drawn as they are. Throws
// DeviceError where the solver refuses the scene.
Image8 draw_error(const Scene& scene, const ImageF& picture, const std::string& method, const StopCheck& stop = {});

}  // namespace penumbra
