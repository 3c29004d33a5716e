// SPDX-License-Identifier: MIT
// What a debug view looks at (docs/scene-format.md, `render.view`).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/scene/scene.h"

namespace penumbra {

enum class LookAt {
    picture,       // no view
    field,         // distance, normals, tiles: what every method has before the light
    cascade,       // one cascade or level of a method
    probes,
    steps,
    skipped,
    contribution,  // the picture in which one thing alone shines
    error
};

struct Look {
    LookAt at = LookAt::picture;
    int number = 0;  // of a cascade
};

// Precondition: is_known_view(view).
Look look_of(std::string_view view);

// The scene in which only what the view names shines (light3, shape0, sky), with the view "final". `scene` as it was sent.
Scene contribution(const Scene& scene);

// Lets a shape no longer shine; it is as opaque as before.
void darken(Shape& shape);

// Why this view cannot be had of this scene; empty: it can.
std::string view_refused(const Scene& scene);

}  // namespace penumbra
