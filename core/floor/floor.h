// SPDX-License-Identifier: MIT
// The floor at a place: its albedo, which way it faces, and what the eye sees of it.
#pragma once

#include "core/floor/response.h"

namespace penumbra {

struct FloorPlace {
    Colour albedo{1};
    glm::dvec3 normal{0, 0, 1};  // x right, y down, z towards the eye
};

// Light that arrives from all azimuths, each at every elevation alike: the mean radiance, and the mean of radiance times direction.
struct FieldMoments {
    Colour mean{0};
    Colour x{0}, y{0};
};

class Floor {
public:
    explicit Floor(const Canvas& canvas);

    // At a point of the world, as a pixel of the canvas holds it: pictures are linear between the centres of their texels, and where
    // a pixel covers several texels it holds the mean of as many places.
    FloorPlace at(Point p) const;

    // What it sends up. A field of light and each light in flatland is known by its moments, and never takes light away.
    Colour lit_by(const FloorPlace& place, const FieldMoments& field) const;
    // Light of a beam with this illuminance across.
    Colour lit_by_beam(const FloorPlace& place, const glm::dvec3& to_light, const Colour& across) const;

    const FloorResponse& response() const { return response_; }
    // Whether all places are alike.
    bool is_even() const { return !image_.texels && !normals_.texels; }

private:
    // A picture and where it lies.
    struct Picture {
        const Texels* texels = nullptr;
        int samples = 1;  // along each side of a pixel
    };
    Picture placed(const Texels* texels, double pixel) const;
    template <class Decode>
    glm::dvec3 mean_of(const Picture& picture, Point p, Decode decode) const;

    Colour albedo_;
    ViewRect tile_;
    double pixel_;
    Picture image_, normals_;
    FloorResponse response_;
};

// Decodes one texel of a normal map: 128 is 0, 1 and 255 are -1 and 1; green points up. Not normalised.
glm::dvec3 decoded_normal(const std::uint8_t* texel);

}  // namespace penumbra
