// SPDX-License-Identifier: MIT
// Tone curves in double precision: the twin of glsl/lib/tonemap.glsl. Linear in, linear out, not yet clipped.
#pragma once

#include <string>

#include "core/film/tone_lut.h"
#include "core/scene/scene.h"

namespace penumbra {

// `lut` is for "tony" only, and must be there for it.
Colour tonemap(const Colour& linear, const OutputSettings& output, const ToneLut* lut = nullptr);

}  // namespace penumbra
