// SPDX-License-Identifier: MIT
// What a shape is made of: the keys that all shapes but bitmaps share.
#pragma once

#include "core/scene/limits.h"
#include "core/scene/scene.h"
#include "server/json/value_reader.h"

namespace penumbra {

// `members`: of the shape at `where`.
void read_material(ValueReader& reader, const Members& members, const Path& where, const Limits& limits, Shape& shape);

}  // namespace penumbra
