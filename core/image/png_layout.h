// SPDX-License-Identifier: MIT
// In which of PNG's forms a picture is stored without loss: grey, by a palette, with or without alpha, in how many bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/codec.h"

namespace penumbra {

struct PngLayout {
    enum class Colour : std::uint8_t { grey = 0, rgb = 2, palette = 3, grey_alpha = 4, rgba = 6 };  // the file's own numbers
    Colour colour = Colour::rgb;
    int bit_depth = 8;
    std::vector<std::uint32_t> palette;  // r | g << 8 | b << 16 | a << 24; those that are not opaque first
    Bytes indices;                       // of each pixel, with a palette

    std::size_t bits_per_pixel() const;
};

PngLayout choose_png_layout(const Image8& image);

// Row y as the file holds it, before its filter. `row` has room for (width * bits_per_pixel + 7) / 8 bytes.
void pack_png_row(const Image8& image, const PngLayout& layout, int y, std::uint8_t* row);

}  // namespace penumbra
