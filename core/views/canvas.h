// SPDX-License-Identifier: MIT
// What a debug view is drawn with: colours from 0 to 1 as they are encoded, and small letters.
#pragma once

#include <string_view>

#include <glm/vec3.hpp>

#include "core/image/image.h"

namespace penumbra {

void put(Image8& picture, int x, int y, glm::dvec3 colour);  // outside of the picture: nothing
void fill(Image8& picture, int x, int y, int width, int height, glm::dvec3 colour);

// Letters of 3 x 5 dots, each dot `scale` pixels; capitals and small ones look the same. Returns the width in pixels.
int write(Image8& picture, int x, int y, std::string_view text, glm::dvec3 colour, int scale);
int text_width(std::string_view text, int scale);
constexpr int kLetterHeight = 5;

// From 0 to 1: dark blue, green, yellow; as legible in grey. Fitted to the map "viridis" (van der Walt and Smith, 2015).
glm::dvec3 heat(double t);
// A direction's colour: once round the circle.
glm::dvec3 hue(double turns);

}  // namespace penumbra
