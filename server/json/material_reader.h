// SPDX-License-Identifier: MIT
// What shapes and the floor are made of.
#pragma once

#include "core/scene/limits.h"
#include "server/json/bitmap_reader.h"
#include "server/json/value_reader.h"

namespace penumbra {

void read_material(ValueReader& reader, const Limits& limits, const Path& where, const Members& members, Shape& shape);
// The same of a stroke, whose emission may be a gradient.
void read_stroke_material(ValueReader& reader, const Limits& limits, const Path& where, const Members& members, Shape& shape);

// What the floor has beside its albedo.
void read_floor_material(ValueReader& reader, BitmapReader& bitmaps, const Path& where, const Members& members, FloorMaterial& floor);

}  // namespace penumbra
