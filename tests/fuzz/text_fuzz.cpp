// SPDX-License-Identifier: MIT
// Any bytes as a text to be set: refused, or finite rings.
#include <cmath>

#include "check.h"
#include "core/outline/text.h"
#include "server/json/font_source.h"

using namespace penumbra;
using fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FontSource kFonts;
    const Font* font = kFonts.font();
    check(font != nullptr, "there is a font (fonts-dejavu-core)");
    if (size == 0) return 0;
    TextSettings settings;
    settings.anchor = data[0] % 3 == 0 ? TextAnchor::start : data[0] % 3 == 1 ? TextAnchor::middle : TextAnchor::end;
    settings.size = data[0] % 2 == 0 ? 20 : 1e9;
    settings.tolerance = data[0] % 5 == 0 ? 1e-6 : 0.05;
    settings.most_points = 1024;
    const auto result = rings_of_text(*font, {reinterpret_cast<const char*>(data) + 1, size - 1}, settings);
    if (const auto* error = std::get_if<FontError>(&result)) {
        check(!error->code.empty() && !error->message.empty(), "a refusal says why");
        return 0;
    }
    for (const Ring& ring : std::get<std::vector<Ring>>(result)) {
        for (const Point& point : ring) check(std::isfinite(point.x) && std::isfinite(point.y), "points are finite");
    }
    return 0;
}
