// SPDX-License-Identifier: MIT
// Which method `auto` is for a scene: docs/methods/auto.md tells the figures behind it.
#pragma once

#include <string>

#include "core/plan/device_limits.h"
#include "core/plan/pack_outline.h"
#include "core/plan/split_lights.h"
#include "core/scene/scene.h"

namespace penumbra {

struct MethodChoice {
    std::string method;  // "exact", "hybrid", "hrc" or "rc"
    std::string reason;
};

// What `exact` takes for a pixel, in units of about 0.4 processor microseconds of llvmpipe: the intervals that a point tells
// apart times the pieces of outline (measured over the public scenes; right within a factor of two).
double exact_cost(const PackedOutline& outline);

// `outline` with its survey. For `high` a solved picture may cost more, since sampled ones do.
MethodChoice choose_method(const PackedOutline& outline, Quality quality = Quality::standard);

// Where the brightest lamps of a scene that is sampled are solved sooner than all: the choice of `hybrid` instead of `sampled`.
// `outline` with its survey.
MethodChoice choose_split(const LightSplit& split, const PackedOutline& outline, Quality quality, const MethodChoice& sampled);

// The most pieces of outline for which `auto` looks closer.
std::size_t most_surveyed_pieces();

}  // namespace penumbra
