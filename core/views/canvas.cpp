// SPDX-License-Identifier: MIT
#include "core/views/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

namespace penumbra {
namespace {

// Rows from the top, each a digit of three dots.
struct Letter {
    char letter;
    const char* rows;
};
constexpr Letter kLetters[] = {
    {'0', "75557"}, {'1', "26227"}, {'2', "71747"}, {'3', "71717"}, {'4', "55711"}, {'5', "74717"}, {'6', "74757"}, {'7', "71122"},
    {'8', "75757"}, {'9', "75717"}, {'a', "25755"}, {'b', "65656"}, {'c', "34443"}, {'d', "65556"}, {'e', "74647"}, {'f', "74644"},
    {'g', "34553"}, {'h', "55755"}, {'i', "72227"}, {'j', "11152"}, {'k', "55655"}, {'l', "44447"}, {'m', "57755"}, {'n', "65555"},
    {'o', "25552"}, {'p', "65644"}, {'q', "25531"}, {'r', "65655"}, {'s', "34216"}, {'t', "72222"}, {'u', "55557"}, {'v', "55552"},
    {'w', "55775"}, {'x', "55255"}, {'y', "55222"}, {'z', "71247"}, {'.', "00002"}, {'-', "00700"}, {'+', "02720"}, {':', "02020"},
    {'/', "11244"}, {',', "00024"}, {'(', "24442"}, {')', "21112"},
};

}  // namespace

void put(Image8& picture, int x, int y, glm::dvec3 colour) {
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
    std::uint8_t* to = picture.at(x, y);
    for (int c = 0; c < 3; ++c) to[c] = std::uint8_t(std::clamp(colour[c] * 255 + 0.5, 0.0, 255.0));
}

void fill(Image8& picture, int x, int y, int width, int height, glm::dvec3 colour) {
    for (int v = y; v < y + height; ++v)
        for (int u = x; u < x + width; ++u) put(picture, u, v, colour);
}

int text_width(std::string_view text, int scale) { return int(text.size()) * 4 * scale; }

int write(Image8& picture, int x, int y, std::string_view text, glm::dvec3 colour, int scale) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i] >= 'A' && text[i] <= 'Z' ? char(text[i] - 'A' + 'a') : text[i];
        const auto* letter = std::find_if(std::begin(kLetters), std::end(kLetters), [&](const Letter& l) { return l.letter == c; });
        if (letter == std::end(kLetters)) continue;
        for (int row = 0; row < kLetterHeight; ++row)
            for (int column = 0; column < 3; ++column)
                if (((letter->rows[row] - '0') >> (2 - column) & 1) != 0)
                    fill(picture, x + (int(i) * 4 + column) * scale, y + row * scale, scale, scale, colour);
    }
    return text_width(text, scale);
}

glm::dvec3 heat(double t) {
    t = std::clamp(t, 0.0, 1.0);
    static constexpr std::array<std::array<double, 3>, 6> kStops{{{0.267, 0.005, 0.329}, {0.254, 0.265, 0.530}, {0.164, 0.471, 0.558},
                                                                  {0.135, 0.659, 0.518}, {0.478, 0.821, 0.318}, {0.993, 0.906, 0.144}}};
    const auto low = std::min(std::size_t(t * 5), std::size_t(4));
    const double f = t * 5 - double(low);
    glm::dvec3 colour(0);
    for (int c = 0; c < 3; ++c) colour[c] = kStops[low][std::size_t(c)] * (1 - f) + kStops[low + 1][std::size_t(c)] * f;
    return colour;
}

glm::dvec3 hue(double turns) {
    glm::dvec3 colour(0);
    for (int c = 0; c < 3; ++c) colour[c] = 0.5 + 0.5 * std::cos(6.283185307179586 * (turns - c / 3.0));
    return colour;
}

}  // namespace penumbra
