// SPDX-License-Identifier: MIT
#include "core/plan/support.h"

namespace penumbra {

Problems unsupported(const Scene& scene, const Features& features) {
    Problems problems;
    const auto refuse = [&](std::string pointer, const std::string& what) {
        problems.push_back({std::move(pointer), "not_supported_yet", what + " not supported yet"});
    };
    if (!scene.lights.empty()) refuse("/lights", "point, spot and directional lights are");
    if (scene.render.method == "hybrid") refuse("/render/method", "the method 'hybrid' is");
    if (scene.render.bounces != 0) refuse("/render/bounces", "bounces are");
    if (scene.render.view != "final") refuse("/render/view", "the debug view '" + scene.render.view + "' is");
    if (scene.output.solids != Solids::emission) refuse("/output/solids", "lit solids are");
    if (scene.output.tonemap == "tony" && !features.tone_lut)
        problems.push_back({"/output/tonemap", "not_supported_yet",
                            "the tone map 'tony' is not supported here: its table is no part of this program (see --tony-lut)"});
    return problems;
}

}  // namespace penumbra
