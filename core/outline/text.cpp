// SPDX-License-Identifier: MIT
#include "core/outline/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <cstdio>
#include <optional>
#include <stdexcept>

#include "core/outline/path_data.h"

namespace penumbra {
namespace {

// A face and what it needs, for one text: FreeType's objects are not for several threads at once.
class Face {
public:
    explicit Face(const std::vector<std::uint8_t>& bytes) {
        if (FT_Init_FreeType(&library_) != 0) throw std::runtime_error("FreeType does not start");
        if (FT_New_Memory_Face(library_, bytes.data(), FT_Long(bytes.size()), 0, &face_) != 0) face_ = nullptr;
    }
    ~Face() {
        if (face_ != nullptr) FT_Done_Face(face_);
        FT_Done_FreeType(library_);
    }
    Face(const Face&) = delete;
    Face& operator=(const Face&) = delete;

    bool good() const { return face_ != nullptr && FT_IS_SCALABLE(face_) && face_->units_per_EM > 0; }
    FT_Face get() const { return face_; }

private:
    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
};

// One character; the text is good UTF-8 (the JSON parser saw to that), and what is not reads as U+FFFD.
char32_t next_character(std::string_view text, std::size_t& at) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(at++);
    if (first < 0x80) return first;
    const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    if (more == 0) return 0xfffd;
    char32_t character = first & (0x3fu >> more);
    for (int i = 0; i < more; ++i) {
        if ((byte(at) & 0xc0u) != 0x80u) return 0xfffd;
        character = character << 6 | (byte(at++) & 0x3fu);
    }
    return character;
}

// What FreeType calls back with, in the font's units and y up.
struct Pen {
    std::vector<Ring>& rings;
    Point origin;
    double scale;
    double tolerance;

    Point at(const FT_Vector* v) const { return origin + Point(double(v->x), -double(v->y)) * scale; }
    static int move(const FT_Vector* to, void* user) {
        Pen& pen = *static_cast<Pen*>(user);
        pen.rings.push_back({pen.at(to)});
        return 0;
    }
    static int line(const FT_Vector* to, void* user) {
        Pen& pen = *static_cast<Pen*>(user);
        pen.rings.back().push_back(pen.at(to));
        return 0;
    }
    static int conic(const FT_Vector* control, const FT_Vector* to, void* user) {
        Pen& pen = *static_cast<Pen*>(user);
        append_quadratic(pen.rings.back(), pen.at(control), pen.at(to), pen.tolerance);
        return 0;
    }
    static int cubic(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* user) {
        Pen& pen = *static_cast<Pen*>(user);
        append_cubic(pen.rings.back(), pen.at(first), pen.at(second), pen.at(to), pen.tolerance);
        return 0;
    }
};

struct Placed {
    FT_UInt glyph = 0;
    double x = 0;  // font units
};

struct TextLine {
    std::vector<Placed> glyphs;
    double width = 0;
};

FontError missing(const Font& font, char32_t character, std::string_view text, std::size_t from, std::size_t to) {
    char code[16];
    std::snprintf(code, sizeof code, "U+%04X", unsigned(character));
    return {"missing_glyph", "holds \"" + std::string(text.substr(from, to - from)) + "\" (" + code + "), for which the font " + font.name +
                                 " has no glyph"};
}

}  // namespace

std::variant<Font, std::string> load_font(std::vector<std::uint8_t> bytes) {
    const Face face(bytes);
    if (!face.good()) return "is no font with outlines";
    std::string name = face.get()->family_name != nullptr ? face.get()->family_name : "without a name";
    return Font{std::move(bytes), std::move(name)};
}

std::variant<std::vector<Ring>, FontError> rings_of_text(const Font& font, std::string_view utf8, const TextSettings& settings) {
    const Face face(font.bytes);
    if (!face.good()) return FontError{"no_font", "cannot be set: the font is damaged"};
    FT_Face ft = face.get();
    constexpr FT_Int32 kFlags = FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP;
    std::vector<TextLine> lines(1);
    FT_UInt before = 0;
    std::size_t count = 0;
    for (std::size_t at = 0; at < utf8.size();) {
        const std::size_t from = at;
        const char32_t character = next_character(utf8, at);
        // Every glyph that shows has points: no text of this length can fit.
        if (++count > settings.most_points) break;
        if (character == U'\n') {
            lines.emplace_back();
            before = 0;
            continue;
        }
        const FT_UInt glyph = FT_Get_Char_Index(ft, character);
        if (glyph == 0) return missing(font, character, utf8, from, at);
        TextLine& line = lines.back();
        FT_Vector kerning{0, 0};
        if (before != 0 && FT_HAS_KERNING(ft) && FT_Get_Kerning(ft, before, glyph, FT_KERNING_UNSCALED, &kerning) == 0)
            line.width += double(kerning.x);
        if (FT_Load_Glyph(ft, glyph, kFlags) != 0 || ft->glyph->format != FT_GLYPH_FORMAT_OUTLINE)
            return missing(font, character, utf8, from, at);
        line.glyphs.push_back({glyph, line.width});
        line.width += double(ft->glyph->metrics.horiAdvance);
        before = glyph;
    }
    const double scale = settings.size / double(ft->units_per_EM);
    const double line_height = double(ft->height) * scale;
    std::vector<Ring> rings;
    std::size_t points = 0, counted = 0;
    for (std::size_t row = 0; row < lines.size(); ++row) {
        const TextLine& line = lines[row];
        const double share = settings.anchor == TextAnchor::start ? 0 : settings.anchor == TextAnchor::middle ? 0.5 : 1;
        for (const Placed& placed : line.glyphs) {
            if (points > settings.most_points) return rings;
            if (FT_Load_Glyph(ft, placed.glyph, kFlags) != 0) continue;
            Pen pen{rings, {(placed.x - share * line.width) * scale, double(row) * line_height}, scale, settings.tolerance};
            FT_Outline_Funcs calls{Pen::move, Pen::line, Pen::conic, Pen::cubic, 0, 0};
            FT_Outline_Decompose(&ft->glyph->outline, &calls, &pen);
            for (; counted < rings.size(); ++counted) points += rings[counted].size();
        }
    }
    for (Ring& ring : rings)
        if (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
    return rings;
}

}  // namespace penumbra
