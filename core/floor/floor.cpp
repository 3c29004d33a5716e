// SPDX-License-Identifier: MIT
#include "core/floor/floor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/film/encode.h"

namespace penumbra {
namespace {

// Places along a pixel's side at most that a picture is asked at.
constexpr double kMostSamples = 16;

const std::array<double, 256>& linear_codes() {
    static const std::array<double, 256> codes = [] {
        std::array<double, 256> made{};
        for (std::size_t i = 0; i < made.size(); ++i) made[i] = srgb_decoded(double(i) / 255);
        return made;
    }();
    return codes;
}

glm::dvec3 decoded_colour(const std::uint8_t* texel) {
    const std::array<double, 256>& codes = linear_codes();
    // What is transparent shows no floor: black.
    return glm::dvec3(codes[texel[0]], codes[texel[1]], codes[texel[2]]) * (texel[3] / 255.0);
}

}  // namespace

glm::dvec3 decoded_normal(const std::uint8_t* texel) {
    const auto axis = [](int code) { return std::max((code - 128) / 127.0, -1.0); };
    return {axis(texel[0]), -axis(texel[1]), axis(texel[2])};
}

Floor::Floor(const Canvas& canvas)
    : albedo_(canvas.floor_albedo),
      tile_(canvas.floor.tile.value_or(canvas.view_or_default())),
      pixel_(canvas.pixel_size()),
      image_(placed(canvas.floor.image.get(), pixel_)),
      normals_(placed(canvas.floor.normals.get(), pixel_)),
      response_(canvas.floor.gloss) {}

Floor::Picture Floor::placed(const Texels* texels, double pixel) const {
    if (texels == nullptr) return {};
    const double across = pixel * std::max(texels->width / tile_.w, texels->height / tile_.h);  // texels in a pixel
    return {texels, int(std::clamp(std::ceil(across - 1e-6), 1.0, kMostSamples))};
}

template <class Decode>
glm::dvec3 Floor::mean_of(const Picture& picture, Point p, Decode decode) const {
    const Texels& texels = *picture.texels;
    const auto texel = [&](double x, double y) {
        const auto wrapped = [](double at, int size) { return std::size_t(at - size * std::floor(at / size)) % std::size_t(size); };
        return decode(&texels.rgba[4 * (wrapped(y, texels.height) * std::size_t(texels.width) + wrapped(x, texels.width))]);
    };
    glm::dvec3 sum(0);
    const int n = picture.samples;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const Point q = p + pixel_ * (Point(i + 0.5, j + 0.5) / double(n) - 0.5);
            const double x = (q.x - tile_.x) / tile_.w * texels.width - 0.5, y = (q.y - tile_.y) / tile_.h * texels.height - 0.5;
            const double x0 = std::floor(x + 1e-9), y0 = std::floor(y + 1e-9);
            const double u = std::max(x - x0, 0.0), v = std::max(y - y0, 0.0);
            // Rounding must not mix in a neighbour where the place is a texel's centre.
            if (u < 1e-6 && v < 1e-6)
                sum += texel(x0, y0);
            else
                sum += glm::mix(glm::mix(texel(x0, y0), texel(x0 + 1, y0), u), glm::mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), u), v);
        }
    }
    return sum / double(n * n);
}

FloorPlace Floor::at(Point p) const {
    FloorPlace place;
    place.albedo = albedo_;
    if (image_.texels) place.albedo *= mean_of(image_, p, decoded_colour);
    if (normals_.texels) {
        glm::dvec3 normal = mean_of(normals_, p, decoded_normal);
        normal.z = std::max(normal.z, 0.0);  // it never turns its back to the eye
        const double size = glm::length(normal);
        if (size > 1e-6) place.normal = normal / size;
    }
    return place;
}

Colour Floor::lit_by(const FloorPlace& place, const FieldMoments& field) const {
    const FloorResponse::OfField terms = response_.of_field(place.normal.z);
    const ResponseColours colours = response_.colours(place.albedo, place.normal.z);
    const double size = std::hypot(place.normal.x, place.normal.y);
    const Colour lean = size > 0 ? (field.x * place.normal.x + field.y * place.normal.y) / size : Colour(0);
    const Colour sent = colours.diffuse * (terms.mean.diffuse * field.mean + terms.lean.diffuse * lean) +
                        colours.facets * (terms.mean.facets * field.mean + terms.lean.facets * lean) +
                        colours.rim * (terms.mean.rim * field.mean + terms.lean.rim * lean);
    return glm::max(sent, Colour(0));
}

Colour Floor::lit_by_beam(const FloorPlace& place, const glm::dvec3& to_light, const Colour& across) const {
    const ResponseTerms terms = response_.of_beam(place.normal, to_light);
    const ResponseColours colours = response_.colours(place.albedo, place.normal.z);
    return across * (colours.diffuse * terms.diffuse + colours.facets * terms.facets + colours.rim * terms.rim);
}

}  // namespace penumbra
