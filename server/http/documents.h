// SPDX-License-Identifier: MIT
// What the service tells of itself to programs: docs/openapi.json and docs/scene.schema.json, as they were when it was built.
#pragma once

#include <string_view>

namespace penumbra {

std::string_view openapi_document();
std::string_view scene_schema();

}  // namespace penumbra
