// SPDX-License-Identifier: MIT
#include "core/views/light_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "core/film/encode.h"
#include "core/views/canvas.h"

namespace penumbra {
namespace {

constexpr glm::dvec3 kWhite(1.0), kBlack(0.0);
constexpr int kPad = 4;
constexpr double kTurn = 6.283185307179586;

int scale_of(const Image8& picture) { return picture.width >= 200 ? 2 : 1; }

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

double exceeded_by_few(std::vector<float> values) {
    std::erase_if(values, [](float v) { return !(v > 0); });
    if (values.empty()) return 1;
    const std::size_t few = values.size() / 200;
    const auto at = values.end() - static_cast<std::ptrdiff_t>(few + 1);
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
}

glm::dvec3 shown(glm::dvec3 light, double white) {
    glm::dvec3 colour(0);
    for (int c = 0; c < 3; ++c) colour[c] = srgb_encoded(std::clamp(light[c] / white, 0.0, 1.0));
    return colour;
}

// A legend's bar of heat under the caption, with what its ends mean.
void heat_legend(Image8& picture, const std::vector<std::string>& captions, const std::string& low, const std::string& high) {
    const int scale = scale_of(picture), line = (kLetterHeight + 2) * scale, bar = 40 * scale;
    int width = bar + text_width(low + high, scale) + 4 * scale;
    for (const std::string& caption : captions) width = std::max(width, text_width(caption, scale));
    const int height = (int(captions.size()) + 1) * line;
    const glm::ivec2 box(kPad, picture.height - height - 3 * kPad);
    fill(picture, box.x, box.y, width + 2 * kPad, height + 2 * kPad, kBlack);
    glm::ivec2 at = box + kPad;
    for (const std::string& caption : captions) {
        write(picture, at.x, at.y, caption, kWhite, scale);
        at.y += line;
    }
    const int start = write(picture, at.x, at.y, low, kWhite, scale) + scale;
    for (int x = 0; x < bar; ++x) fill(picture, at.x + start + x, at.y, 1, kLetterHeight * scale, heat(double(x) / (bar - 1)));
    write(picture, at.x + start + bar + 2 * scale, at.y, high, kWhite, scale);
}

template <class Share>
Image8 heat_picture(const HeatField& field, const Share& share) {
    Image8 picture(field.size.x, field.size.y, 3);
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            const double value = double(field.values[std::size_t(y) * std::size_t(field.size.x) + std::size_t(x)]);
            put(picture, x, y, std::isnan(value) ? kBlack : heat(share(value)));
        }
    return picture;
}

}  // namespace

void write_legend(Image8& picture, const std::vector<std::string>& lines) {
    const int scale = scale_of(picture), line = (kLetterHeight + 2) * scale;
    int width = 0;
    for (const std::string& text : lines) width = std::max(width, text_width(text, scale));
    const int height = int(lines.size()) * line;
    const glm::ivec2 box(kPad, picture.height - height - 3 * kPad);
    fill(picture, box.x, box.y, width + 2 * kPad, height + 2 * kPad, kBlack);
    for (std::size_t i = 0; i < lines.size(); ++i) write(picture, box.x + kPad, box.y + kPad + int(i) * line, lines[i], kWhite, scale);
}

double white_of(const ImageF& light) { return exceeded_by_few(light.data); }

Image8 draw_light(const ImageF& light, const std::string& caption) {
    Image8 picture(light.width, light.height, 3);
    const double white = white_of(light);
    for (int y = 0; y < light.height; ++y)
        for (int x = 0; x < light.width; ++x) {
            const float* p = light.at(x, y);
            put(picture, x, y, shown({double(p[0]), double(p[1]), double(p[2])}, white));
        }
    write_legend(picture, {caption, "white: " + number(white)});
    return picture;
}

Image8 draw_heat(const HeatField& field, const std::string& caption) {
    double largest = 0;
    for (const float v : field.values)
        if (!std::isnan(v)) largest = std::max(largest, double(v));
    Image8 picture = heat_picture(field, [&](double v) { return largest > 0 ? v / largest : 0.0; });
    heat_legend(picture, {caption}, "0", number(largest));
    return picture;
}

Image8 draw_log_heat(const HeatField& field, double low, double high, const std::string& caption, const std::string& more) {
    Image8 picture = heat_picture(field, [&](double v) { return v > low ? std::log(v / low) / std::log(high / low) : 0.0; });
    heat_legend(picture, {caption, more}, number(low), number(high));
    return picture;
}

double white_of(const ProbeField& field) {
    std::vector<float> values;
    for (const glm::vec3& light : field.light) values.insert(values.end(), {light.r, light.g, light.b});
    return exceeded_by_few(std::move(values));
}

Image8 draw_probes(const ProbeField& field, const std::string& caption) {
    Image8 picture(field.size.x, field.size.y, 3);
    const double white = white_of(field);
    const auto count = std::size_t(field.probes.x) * std::size_t(field.probes.y);
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            const glm::dvec2 at = (glm::dvec2(x + 0.5, y + 0.5) - field.first) / field.spacing;
            const int i = int(std::lround(at.x)), j = int(std::lround(at.y));
            if (i < 0 || j < 0 || i >= field.probes.x || j >= field.probes.y) continue;
            const double u = at.x - i, v = at.y - j, r = std::hypot(u, v);
            const std::size_t probe = std::size_t(j) * std::size_t(field.probes.x) + std::size_t(i);
            if (field.free[probe] == 0) {
                if (r > 0.3 && r < 0.4) put(picture, x, y, glm::dvec3(0.35));
                continue;
            }
            if (r > 0.46) continue;
            glm::dvec3 light(0);
            if (r < 0.16) {
                for (int g = 0; g < field.groups; ++g) light += glm::dvec3(field.light[std::size_t(g) * count + probe]) / double(field.groups);
            } else {
                double turns = std::atan2(v, u) / kTurn;
                turns -= std::floor(turns);
                light = glm::dvec3(field.light[std::size_t(std::min(int(turns * field.groups), field.groups - 1)) * count + probe]);
            }
            put(picture, x, y, shown(light, white));
        }
    write_legend(picture, {caption, "spacing: " + number(field.spacing) + " px", "white: " + number(white)});
    return picture;
}

}  // namespace penumbra
