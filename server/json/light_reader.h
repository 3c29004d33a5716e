// SPDX-License-Identifier: MIT
#pragma once

#include "server/json/value_reader.h"

namespace penumbra {

// A light whose type is this one of kLightTypes.
Light light_of_type(ValueReader& reader, const Path& where, NodeId id, std::size_t type);

}  // namespace penumbra
