// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <string>

#include "core/renderer.h"

namespace penumbra {

std::string Renderer::self_test() {
    // A lamp of radiance 1 under a grey sky: far from the lamp its share is asin(R / r) / pi.
    Scene scene;
    scene.canvas.width = 48;
    scene.canvas.height = 48;
    scene.sky.radiance = Colour(0.25);
    scene.output.format = "pfm";
    const ImageF open = std::get<ImageF>(render(scene).picture);
    for (const float value : open.data)
        if (!(std::abs(value - 0.25f) < 1e-4f))
            return "A uniform sky of radiance 0.25 rendered as " + std::to_string(value) + ".";
    Shape lamp;
    lamp.geometry = Circle{{24, 24}, 6};
    lamp.emission = Colour(1);
    scene.shapes.push_back(lamp);
    const ImageF lit = std::get<ImageF>(render(scene).picture);
    double mean = 0;
    double expected = 0;
    for (int x = 0; x < 48; ++x) {
        const double distance = std::hypot(x + 0.5 - 24.0, 0.5 - 24.0);
        const double share = std::asin(6.0 / distance) / std::numbers::pi;
        mean += double(*lit.at(x, 0)) / 48;
        expected += (share + 0.25 * (1 - share)) / 48;
    }
    if (!(std::abs(mean / expected - 1) < 0.05))
        return "A disc under a grey sky rendered as " + std::to_string(mean) + " instead of " + std::to_string(expected) + ".";
    return {};
}

}  // namespace penumbra
