// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scene/path.h"
#include "core/scene/range_checks.h"
#include "core/scene/scene.h"

namespace penumbra {

// The part of validate() about the list of shapes at `where`.
void validate_shapes(RangeChecks& checks, const Path& where, const std::vector<Shape>& shapes);

}  // namespace penumbra
