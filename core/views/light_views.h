// SPDX-License-Identifier: MIT
// Looks at what methods make on their way to a picture: light, heat maps, probes. Each with a legend that gives the numbers.
#pragma once

#include <string>
#include <vector>

#include <glm/ext/vector_int2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image/image.h"

namespace penumbra {

// Linear light as sRGB, divided by what the legend calls white: the value that one sample in 200 exceeds.
double white_of(const ImageF& light);
Image8 draw_light(const ImageF& light, const std::string& caption);

// A value for each pixel; NaN is black.
struct HeatField {
    glm::ivec2 size{0};
    std::vector<float> values;
};
// From nothing to the largest, which the legend tells.
Image8 draw_heat(const HeatField& field, const std::string& caption);
// By the logarithm, from `low` to `high`; what is below is as dark as `low`. `more` is written below the caption.
Image8 draw_log_heat(const HeatField& field, double low, double high, const std::string& caption, const std::string& more);

// Probes of one cascade: what arrives at each from each group of directions.
struct ProbeField {
    glm::ivec2 size{0};        // of the picture
    glm::ivec2 probes{0};
    glm::dvec2 first{0};       // px, centre of the first
    double spacing = 1;        // px
    int groups = 0;            // group g is centred on (g + 0.5) / groups of a turn, clockwise on screen
    std::vector<glm::vec3> light;  // group by group, row by row
    std::vector<char> free;        // by probe: 0 inside a shape
};
// Each probe as a rose of its directions, its own mean in the middle; probes inside shapes are grey rings.
Image8 draw_probes(const ProbeField& field, const std::string& caption);
double white_of(const ProbeField& field);

// Writes a legend of lines into the lower left corner of a finished picture.
void write_legend(Image8& picture, const std::vector<std::string>& lines);

}  // namespace penumbra
