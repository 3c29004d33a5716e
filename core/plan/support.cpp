// SPDX-License-Identifier: MIT
#include "core/plan/support.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "core/plan/look.h"
#include "core/plan/skip.h"

namespace penumbra {

Problems unsupported(const Scene& scene, const Features& features) {
    Problems problems;
    const auto refuse = [&](std::string pointer, const std::string& what) {
        problems.push_back({std::move(pointer), "not_supported_yet", what + " not supported yet"});
    };
    const bool reflecting = std::any_of(scene.shapes.begin(), scene.shapes.end(), [](const Shape& shape) { return reflects(shape); });
    if (scene.render.method == "hybrid" && scene.render.bounces > 0 && reflecting)
        refuse("/render/bounces", "light that bounces with the method 'hybrid' is");
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        if (!scene.shapes[i].medium) continue;
        const std::string medium = "/shapes/" + std::to_string(i) + "/medium";
        if (scene.render.method == "exact" || scene.render.method == "hybrid")
            refuse("/render/method", "the method '" + scene.render.method + "' with translucent shapes (" + medium + ") is");
        if (scene.render.bounces > 0) refuse("/render/bounces", "light that bounces in a scene with translucent shapes (" + medium + ") is");
        if (scene.canvas.floor.has_relief())
            refuse("/canvas/floor", "a floor with a normal_map, roughness, metallic or reflectance in a scene with translucent shapes (" + medium + ") is");
        break;
    }
    if (scene.canvas.floor.has_relief() && scene.render.method != "auto" && scene.render.method != "exact")
        refuse("/canvas/floor", "a floor with a normal_map, roughness, metallic or reflectance with the method '" + scene.render.method + "' is");
    const std::string& view = scene.render.view;
    if (const std::string why = view_refused(scene); !why.empty())
        problems.push_back({"/render/view", "not_supported_yet", "the view '" + view + "' is not supported here: " + why});
    // What one thing alone gives is a picture as any other.
    else if (view != "final" && look_of(view).at != LookAt::contribution && (scene.output.format != "png" || scene.output.bit_depth.value_or(8) != 8))
        problems.push_back({"/render/view", "not_supported_yet", "a debug view comes as a PNG of 8 bits; other formats of it are not supported yet"});
    if (scene.output.tonemap == "tony" && !features.tone_lut)
        problems.push_back({"/output/tonemap", "not_supported_yet",
                            "the tone map 'tony' is not supported here: its table is no part of this program (see --tony-lut)"});
    return problems;
}

}  // namespace penumbra
