// SPDX-License-Identifier: MIT
// Text as rings: the outlines of a font's glyphs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/outline/rings.h"

namespace penumbra {

// A font file, whole, and its family's name.
struct Font {
    std::vector<std::uint8_t> bytes;
    std::string name;
};

// TrueType, OpenType: whatever FreeType reads that has outlines. Else a sentence.
std::variant<Font, std::string> load_font(std::vector<std::uint8_t> bytes);

enum class TextAnchor { start, middle, end };

struct TextSettings {
    double size = 1;  // of the font's em
    TextAnchor anchor = TextAnchor::start;
    double tolerance = 0.01;
    std::size_t most_points = 16384;  // the rings end soon after as many
};

struct FontError {
    std::string code;
    std::string message;
};

// The rings (filled by the nonzero rule) of UTF-8 text whose first base line begins, or has its middle or end, at the origin. Glyphs stand
// side by side by the font's own widths and its kerning table; lines end in "\n". Nothing is shaped further: no ligatures, no marks
// on letters, no writing from right to left.
std::variant<std::vector<Ring>, FontError> rings_of_text(const Font& font, std::string_view utf8, const TextSettings& settings);

}  // namespace penumbra
