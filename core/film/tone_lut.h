// SPDX-License-Identifier: MIT
// A tone curve as a table of colours, read from a DDS file: what Tony McMapface comes as
// (github.com/h3r2tic/tony-mc-mapface). The file is no part of this program.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/scene/scene.h"

namespace penumbra {

struct ToneLut {
    int size = 0;                   // texels on a side
    std::vector<glm::vec3> texels;  // red fastest, then green, then blue

    // Between texels, in a line along each axis; 0 is the middle of the first texel and 1 that of the last.
    Colour at(const Colour& stimulus) const;
};

// DDS with a DX10 header, a cube of R9G9B9E5 or RGBA32F. Else a sentence.
std::variant<ToneLut, std::string> decode_tone_lut(std::span<const std::uint8_t> bytes);

}  // namespace penumbra
