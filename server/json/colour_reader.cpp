// SPDX-License-Identifier: MIT
// The colour forms: a number, [r, g, b], "#rrggbb", { "color": ..., "intensity": ... }.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/scene/wording.h"
#include "server/json/scene_keys.h"
#include "server/json/value_reader.h"

namespace penumbra {

namespace {

constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kForm =
    "a colour (a number, [r, g, b], \"#rrggbb\" or {\"color\": ..., \"intensity\": ...})";
constexpr std::string_view kPlainForm = "a colour (a number, [r, g, b] or \"#rrggbb\")";

int hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    if (c >= 'a' && c <= 'f') {
        return c - 'a' + 10;
    }
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// IEC 61966-2-1.
double srgb_to_linear(int byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

}  // namespace

Colour ValueReader::hex_colour(const Path& where, NodeId id) {
    const std::string_view text = node(id).string;
    std::array<int, 3> bytes{};
    bool good = text.size() == 7 && text[0] == '#';
    for (std::size_t i = 0; good && i < 3; ++i) {
        const int high = hex_digit(text[1 + 2 * i]);
        const int low = hex_digit(text[2 + 2 * i]);
        good = high >= 0 && low >= 0;
        bytes[i] = high * 16 + low;
    }
    if (!good) {
        report(where, id, "bad_colour",
               [&] { return "must be \"#\" and six hexadecimal digits, is " + in_quotes(text); });
        return Colour(kUnread);
    }
    return {srgb_to_linear(bytes[0]), srgb_to_linear(bytes[1]), srgb_to_linear(bytes[2])};
}

Colour ValueReader::plain_colour(const Path& where, NodeId id, bool in_object) {
    Colour colour(kUnread);
    switch (node(id).kind) {
        case NodeKind::number:
            colour = Colour(node(id).number);
            break;
        case NodeKind::string:
            return hex_colour(where, id);
        case NodeKind::array: {
            const auto channels = numbers(where, id, 3, "a colour of three numbers [r, g, b]");
            colour = {channels[0], channels[1], channels[2]};
            break;
        }
        default:
            expect(where, id, NodeKind::number, in_object ? kPlainForm : kForm);
    }
    // Inside an object the validation sees the product only.
    if (in_object && (colour.r < 0 || colour.g < 0 || colour.b < 0)) {
        report(where, id, "out_of_range", [&] {
            return "must be at least 0, is " +
                   number_text(std::min({colour.r, colour.g, colour.b}));
        });
        return Colour(kUnread);
    }
    return colour;
}

Colour ValueReader::colour_object(const Path& where, NodeId id) {
    const Members members(*this, where, id, kColourKeys, "a colour");
    const NodeId color = members.require("color");
    Colour colour(kUnread);
    if (color != kNoNode) {
        colour = plain_colour(where.key("color"), color, true);
    } else {
        problems_.silence(where.pointer());
    }
    double intensity = 1;
    members.number("intensity", intensity);
    if (intensity < 0) {
        report(where.key("intensity"), members.find("intensity"), "out_of_range",
               [&] { return "must be at least 0, is " + number_text(intensity); });
        intensity = kUnread;
    }
    const Colour product = colour * intensity;
    if (std::isnan(product.r) && !problems_.full()) {
        problems_.silence(where.pointer());  // what went wrong inside has been said
    }
    return product;
}

Colour ValueReader::colour(const Path& where, NodeId id) {
    return node(id).kind == NodeKind::object ? colour_object(where, id)
                                             : plain_colour(where, id, false);
}

}  // namespace penumbra
