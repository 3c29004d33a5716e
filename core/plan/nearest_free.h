// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/ext/vector_int2.hpp>

namespace penumbra {

// For each pixel the nearest one that is free (itself where it is), exactly, by distances between centres: the lower envelope of
// parabolas, columns first (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions", 2012). Of two that are as near, either.
// `solid` holds a value for each pixel, row by row. Empty when no pixel is free.
std::vector<glm::ivec2> nearest_free(const std::vector<std::uint8_t>& solid, glm::ivec2 size);

}  // namespace penumbra
