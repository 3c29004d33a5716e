// SPDX-License-Identifier: MIT
// Point, spot and directional lights as the device reads them (glsl/delta.h).
#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "core/plan/pack_outline.h"
#include "core/scene/scene.h"

namespace penumbra {

struct DeltaPlan {
    std::vector<glm::vec4> lights;  // kDeltaLightTexels each; empty: the scene has none
    PackedOutline outline;          // empty where the method `exact` brings one
    int size() const;
    bool used() const { return !lights.empty(); }
};

// Lights that give nothing are left out. Positions in pixels of the view; intensities such that the irradiance at r pixels is
// intensity / r, or intensity / d^2 of those that stand at a height (light-transport.md has world units).
std::vector<glm::vec4> pack_lights(const Scene& scene);

}  // namespace penumbra
