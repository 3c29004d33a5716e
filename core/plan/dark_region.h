// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace penumbra {

// The ring of outline about one such region, px of the view: corners and points on its arcs. Inside it nothing shines, neither
// the ring nor what stands within.
struct DarkRegion {
    std::vector<glm::dvec2> ring;
};

}  // namespace penumbra
