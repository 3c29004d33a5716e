// SPDX-License-Identifier: MIT
#include "server/json/sky_picture.h"

#include <algorithm>
#include <cmath>

#include "core/film/encode.h"

namespace penumbra {

std::vector<SkyStop> sky_of_row(const Texels& texels, int row, double scale, std::size_t most) {
    const auto width = std::size_t(texels.width);
    const auto colour = [&](std::size_t x) {
        const std::uint8_t* p = texels.rgba.data() + 4 * (std::size_t(row) * width + x);
        const double factor = scale * p[3] / 255.0;
        return Colour(srgb_decoded(p[0] / 255.0), srgb_decoded(p[1] / 255.0), srgb_decoded(p[2] / 255.0)) * factor;
    };
    const std::size_t parts = std::min(width, most);
    std::vector<SkyStop> stops;
    for (std::size_t part = 0; part < parts; ++part) {
        const double from = double(part) * double(width) / double(parts), to = double(part + 1) * double(width) / double(parts);
        Colour sum(0);
        for (auto x = std::size_t(from); x < width && double(x) < to; ++x)
            sum += colour(x) * (std::min(to, double(x) + 1) - std::max(from, double(x)));
        stops.push_back({(double(part) + 0.5) * 360.0 / double(parts), sum / (to - from)});
    }
    return stops;
}

}  // namespace penumbra
