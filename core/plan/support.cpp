// SPDX-License-Identifier: MIT
#include "core/plan/support.h"

namespace penumbra {

Problems unsupported(const Scene& scene, const Features& features) {
    Problems problems;
    const auto refuse = [&](std::string pointer, const std::string& what) {
        problems.push_back({std::move(pointer), "not_supported_yet", what + " not supported yet"});
    };
    if (scene.render.method == "hybrid") refuse("/render/method", "the method 'hybrid' is");
    if (scene.canvas.floor.has_relief() && scene.render.method != "auto" && scene.render.method != "exact")
        refuse("/canvas/floor", "a floor with a normal_map, roughness, metallic or reflectance with the method '" + scene.render.method + "' is");
    const std::string& view = scene.render.view;
    if (view != "final" && view != "distance" && view != "normals" && view != "tiles")
        problems.push_back({"/render/view", "not_supported_yet",
                            "the debug view '" + view + "' is not supported yet: there are distance, normals and tiles"});
    else if (view != "final" && (scene.output.format != "png" || scene.output.bit_depth.value_or(8) != 8))
        problems.push_back({"/render/view", "not_supported_yet", "a debug view comes as a PNG of 8 bits; other formats of it are not supported yet"});
    if (scene.output.tonemap == "tony" && !features.tone_lut)
        problems.push_back({"/output/tonemap", "not_supported_yet",
                            "the tone map 'tony' is not supported here: its table is no part of this program (see --tony-lut)"});
    return problems;
}

}  // namespace penumbra
