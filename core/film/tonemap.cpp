// SPDX-License-Identifier: MIT
#include "core/film/tonemap.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace penumbra {
namespace {

using glm::dmat3;
using glm::dvec3;

// Of rows, as the formulas are printed.
dmat3 rows(dvec3 a, dvec3 b, dvec3 c) { return dmat3(a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z); }

dvec3 aces_hill(dvec3 c) {
    static const dmat3 in = rows({0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777});
    static const dmat3 out = rows({1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602});
    const dvec3 v = in * c;
    return out * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
dvec3 aces_narkowicz(dvec3 c) { return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14); }

struct Look {
    dvec3 slope;
    double power;
    double saturation;
};

// ASC CDL; luma is taken before the power, as in Wrensch's and Filament's.
dvec3 graded(dvec3 v, const Look& look) {
    v = glm::max(v * look.slope, dvec3(0));
    const double luma = glm::dot(v, dvec3(0.2126, 0.7152, 0.0722));
    v = glm::pow(v, dvec3(look.power));
    return luma + look.saturation * (v - luma);
}

dvec3 agx(dvec3 c, const std::string& look) {
    static const dmat3 inset = rows({0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                    {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                    {0.0423756549057051, 0.0784336, 0.879142973793104});
    static const dmat3 outset = rows({1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                     {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                     {-0.0529716355144438, -0.0980434501171241, 1.15107367264116});
    dvec3 v = inset * c;
    v = glm::clamp((glm::log2(glm::max(v, dvec3(1e-10))) + 12.47393) / 16.5, 0.0, 1.0);
    const dvec3 v2 = v * v, v4 = v2 * v2;
    v = 15.5 * v4 * v2 - 40.14 * v4 * v + 31.96 * v4 - 6.868 * v2 * v + 0.4298 * v2 + 0.1191 * v - 0.00232;
    if (look == "golden") v = graded(v, {{1.0, 0.9, 0.5}, 0.8, 1.3});
    if (look == "punchy") v = graded(v, {{1.0, 1.0, 1.0}, 1.35, 1.4});
    return glm::pow(glm::max(outset * v, dvec3(0)), dvec3(2.2));
}

// Khronos PBR Neutral, the current specification: mixes towards the new peak, not towards 1.
dvec3 pbr_neutral(dvec3 c) {
    const double x = std::min({c.r, c.g, c.b});
    c -= x <= 0.08 ? x - x * x / 0.16 : 0.04;
    const double peak = std::max({c.r, c.g, c.b});
    if (peak <= 0.76) return c;
    const double compressed = 1 - 0.24 * 0.24 / (peak + 1 - 1.52);
    const double g = 1 / (0.15 * (peak - compressed) + 1);
    return c * (compressed / peak) * g + compressed * (1 - g);
}

}  // namespace

Colour tonemap(const Colour& linear, const OutputSettings& output, const ToneLut* lut) {
    const std::string& name = output.tonemap;
    // Beyond this every curve is flat, and squares stay finite.
    const dvec3 c = glm::clamp(linear, dvec3(0), dvec3(1e30));
    if (name == "reinhard") return c / (1.0 + c);
    const double white = output.white.value_or(kDefaultWhite);
    if (name == "reinhard_extended") return c * (1.0 + c / (white * white)) / (1.0 + c);
    if (name == "aces") return aces_hill(c);
    if (name == "aces_narkowicz") return aces_narkowicz(c);
    if (name == "agx") return agx(c, output.look.value_or("none"));
    if (name == "pbr_neutral") return pbr_neutral(c);
    if (name == "tony") {
        assert(lut != nullptr);
        return lut->at(c / (1.0 + c));
    }
    return c;
}

}  // namespace penumbra
