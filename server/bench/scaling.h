// SPDX-License-Identifier: MIT
// How cost grows with the scene: shapes, canvas, emitters.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/service/engine.h"

namespace penumbra {

struct ScalingSettings {
    std::vector<std::string> methods;
    std::vector<std::string> curves;  // of scaling_curves(); empty: all
    std::string quality = "standard";
    int repeats = 3;
    double most_seconds = 20;  // a curve ends after the first point that cost more processor time
};

// The names of what can grow.
std::vector<std::string> scaling_curves();

// Renders scenes of a growing number of discs, size of the canvas and number of lamps; tells each point as a line of JSON.
void measure_scaling(const ScalingSettings& settings, RenderBackend& backend, const Engine& engine,
                     const std::function<void(const std::string& row)>& tell);

// A scene of the curves, for tests: `shapes` discs that cover a tenth of a square view, the first `emitters` of them lamps.
Scene scaling_scene(int shapes, int emitters, int side);

}  // namespace penumbra
