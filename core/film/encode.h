// SPDX-License-Identifier: MIT
// From linear light to codes: the sRGB curve, dither, rounding. The twin of what glsl/compose.comp does.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace penumbra {

// IEC 61966-2-1, for values from 0 to 1.
double srgb_encoded(double linear);
double srgb_decoded(double encoded);

// Three pairs of numbers in [0, 1), 16 bits each, that depend on nothing but the pixel: pcg3d (Jarzynski and Olano, "Hash Functions
// for GPU Rendering", JCGT 2020).
struct PixelNoise {
    double first[3];
    double second[3];
};
PixelNoise pixel_noise(int x, int y);

// The code of a value from 0 to 1, `largest` being that of 1: to the nearest, or with dither. The dither is triangular, first - second,
// from -1 to 1 codes: its mean is the value, and its variance the same everywhere. Within half a code of black and of white, where
// it would be cut off and shift the mean, one code wide: black stays black.
int code_of(double value, int largest);
int dithered_code_of(double value, int largest, double first, double second);

}  // namespace penumbra
