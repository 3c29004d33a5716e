// SPDX-License-Identifier: MIT
// How a floor answers light: a microfacet model with the formulas of the errata (E-22 to E-28), seen from straight above.
// docs/methods/floor.md defines it.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/scene/scene.h"

namespace penumbra {

// The parts of a response, each to be multiplied with its colours (see floor_colours); without gloss there is but the first.
struct ResponseTerms {
    double diffuse = 0;
    double facets = 0;  // of what is mirrored head on
    double rim = 0;     // what is mirrored more at grazing angles
};

// What the parts are multiplied with.
struct ResponseColours {
    Colour diffuse{0};
    Colour facets{0};
    Colour rim{0};
};

// Roughness below this is taken for it: errata E-27.
constexpr double kLeastRoughness = 0.045;

// Trowbridge and Reitz's distribution of facets (GGX), by the cosine of their angle from the normal; roughness squared is `alpha`.
double facet_distribution(double cosine, double alpha);
// Smith's visibility, height-correlated (Heitz 2014), the 1 / (4 n.l n.v) within. Not both cosines may be 0: errata E-26.
double facet_visibility(double nl, double nv, double alpha);
// Burley's diffuse term for a base colour of 1: errata E-23.
double burley_diffuse(double nl, double nv, double lh, double alpha);

class FloorResponse {
public:
    explicit FloorResponse(const std::optional<Gloss>& gloss);

    // Radiance towards the eye, per illuminance across a beam from the direction `to_light` (a unit vector, z up), of a floor that
    // faces `normal`.
    ResponseTerms of_beam(const glm::dvec3& normal, const glm::dvec3& to_light) const;

    // The colours at a place with this albedo, whose normal is this much upright.
    ResponseColours colours(const Colour& albedo, double normal_z) const;

    // Of light that comes, at every elevation alike, from all azimuths: the response's mean over azimuths, and its part that goes with
    // the cosine of the azimuth from the one that the floor leans to, both times 2 pi. From a table of tilts, linear between them.
    struct OfField {
        ResponseTerms mean, lean;
    };
    OfField of_field(double normal_z) const;
    // The same by integration.
    OfField integrated(double normal_z) const;

    // Share that the facets mirror of light from everywhere, seen at this cosine, if they mirrored all: E(v) of errata E-28.
    double mirrored(double cosine) const;

    // Rows of kTilts for the device: (mean, lean) of diffuse and facets; of rim, and `mirrored`.
    static constexpr int kTilts = 128;
    std::vector<glm::vec4> table() const;

private:
    std::optional<Gloss> gloss_;
    double alpha_ = 0;
    struct Row {
        OfField field;
        double mirrored = 1;
    };
    std::vector<Row> rows_;  // by the angle of tilt, evenly from 0 to 90 degrees
    Row at(double normal_z) const;
};

}  // namespace penumbra
