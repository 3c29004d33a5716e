// SPDX-License-Identifier: MIT
#include "core/views/views.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/views/canvas.h"

namespace penumbra {
namespace {

constexpr glm::dvec3 kWhite(1.0), kBlack(0.0);
constexpr int kPad = 4;

int scale_of(const Image8& picture) { return picture.width >= 200 ? 2 : 1; }

float distance_at(const ViewField& field, int x, int y) {
    x = std::clamp(x, 0, field.size.x - 1);
    y = std::clamp(y, 0, field.size.y - 1);
    return field.distance[std::size_t(y) * std::size_t(field.size.x) + std::size_t(x)];
}

// A dark box in the lower left corner with room for its contents; returns where they begin.
glm::ivec2 legend_box(Image8& picture, int width, int height) {
    const glm::ivec2 at(kPad, picture.height - height - 3 * kPad);
    fill(picture, at.x, at.y, width + 2 * kPad, height + 2 * kPad, kBlack);
    return at + kPad;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

// 1, 2 or 5 times a power of ten: some ten contours across the picture.
double contour_step(double largest) {
    const double wanted = std::max(largest / 10, 1e-3);
    const double power = std::pow(10.0, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= wanted) return factor * power;
    return 10 * power;
}

}  // namespace

Image8 draw_distance(const ViewField& field) {
    Image8 picture(field.size.x, field.size.y, 3);
    double largest = 1;
    const double far = field.size.x + field.size.y;  // nothing is near where there are no shapes
    for (const float d : field.distance)
        if (std::abs(double(d)) < far) largest = std::max(largest, std::abs(double(d)));
    const double step = contour_step(largest);
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            const double d = double(distance_at(field, x, y));
            const double t = std::sqrt(std::min(std::abs(d) / largest, 1.0));
            glm::dvec3 colour = d <= 0 ? glm::mix(glm::dvec3(1.0, 0.75, 0.35), glm::dvec3(0.55, 0.15, 0.05), t)
                                       : glm::mix(glm::dvec3(0.75, 0.9, 1.0), glm::dvec3(0.05, 0.1, 0.3), t);
            // A contour is a pixel wide wherever the distance changes by one in one pixel.
            const double to_contour = std::abs(d / step - std::round(d / step)) * step;
            if (to_contour < 0.5 && std::abs(d) > step / 2) colour *= 0.55;
            if (std::abs(d) < 0.75) colour = kWhite;
            put(picture, x, y, colour);
        }
    const int scale = scale_of(picture), line = (kLetterHeight + 2) * scale;
    const std::string contours = "contours: " + number(step) + " px", extent = "largest: " + number(largest) + " px";
    const glm::ivec2 at = legend_box(picture, std::max(text_width(contours, scale), text_width(extent, scale)), 3 * line);
    write(picture, at.x, at.y, contours, kWhite, scale);
    write(picture, at.x, at.y + line, extent, kWhite, scale);
    const int inside = write(picture, at.x, at.y + 2 * line, "inside", {1.0, 0.75, 0.35}, scale);
    write(picture, at.x + inside + 4 * scale, at.y + 2 * line, "outside", {0.75, 0.9, 1.0}, scale);
    return picture;
}

Image8 draw_normals(const ViewField& field) {
    Image8 picture(field.size.x, field.size.y, 3);
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            const glm::dvec2 slope(double(distance_at(field, x + 1, y)) - double(distance_at(field, x - 1, y)),
                                   double(distance_at(field, x, y + 1)) - double(distance_at(field, x, y - 1)));
            // Ridges, where two outlines are as near, have no direction.
            const double strength = std::min(glm::length(slope) / 2, 1.0);
            glm::dvec3 colour = strength > 0.05 ? hue(std::atan2(slope.y, slope.x) / 6.283185307179586) * strength : kBlack;
            if (distance_at(field, x, y) <= 0) colour = glm::mix(colour, kWhite, 0.55);
            put(picture, x, y, colour);
        }
    const int scale = scale_of(picture), radius = 8 * scale, line = (kLetterHeight + 2) * scale;
    const std::string words = "away from the nearest outline";
    const std::string first = words.substr(0, 13), second = words.substr(14);
    const glm::ivec2 at = legend_box(picture, 2 * radius + 2 * scale + text_width(second, scale), 2 * radius);
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
            if (x * x + y * y <= radius * radius && x * x + y * y > radius * radius / 6)
                put(picture, at.x + radius + x, at.y + radius + y, hue(std::atan2(double(y), double(x)) / 6.283185307179586));
    write(picture, at.x + 2 * radius + 3 * scale, at.y, first, kWhite, scale);
    write(picture, at.x + 2 * radius + 3 * scale, at.y + line, second, kWhite, scale);
    return picture;
}

Image8 draw_tiles(const ViewField& field, const std::vector<int>& counts, glm::ivec2 tiles, glm::ivec2 border, int tile) {
    Image8 picture(field.size.x, field.size.y, 3);
    const int most = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            const glm::ivec2 at((x + border.x) / tile, (y + border.y) / tile);
            const int count = counts[std::size_t(at.y) * std::size_t(tiles.x) + std::size_t(at.x)];
            glm::dvec3 colour = count == 0 ? kBlack : heat(most > 1 ? double(count - 1) / double(most - 1) : 0);
            const bool edge = (x + border.x) % tile == 0 || (y + border.y) % tile == 0;
            if (edge) colour *= 0.75;
            if (std::abs(double(distance_at(field, x, y))) < 0.75) colour = kWhite;
            put(picture, x, y, colour);
        }
    const int scale = scale_of(picture), line = (kLetterHeight + 2) * scale, bar = 40 * scale;
    const std::string words = "shapes asked a tile", high = std::to_string(most);
    const glm::ivec2 at = legend_box(picture, std::max(text_width(words, scale), bar + text_width("1" + high, scale) + 4 * scale), 2 * line);
    write(picture, at.x, at.y, words, kWhite, scale);
    const int start = write(picture, at.x, at.y + line, "1", kWhite, scale) + scale;
    for (int x = 0; x < bar; ++x) fill(picture, at.x + start + x, at.y + line, 1, kLetterHeight * scale, heat(double(x) / (bar - 1)));
    write(picture, at.x + start + bar + 2 * scale, at.y + line, high, kWhite, scale);
    return picture;
}

}  // namespace penumbra
