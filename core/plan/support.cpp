// SPDX-License-Identifier: MIT
#include "core/plan/support.h"

namespace penumbra {

Problems unsupported(const Scene& scene) {
    Problems problems;
    const auto refuse = [&](std::string pointer, const std::string& what) {
        problems.push_back({std::move(pointer), "not_supported_yet", what + " not supported yet"});
    };
    if (scene.render.method == "hybrid") refuse("/render/method", "the method 'hybrid' is");
    if (scene.render.bounces != 0 && scene.render.method != "auto" && scene.render.method != "exact")
        refuse("/render/bounces", "bounces with the method '" + scene.render.method + "' are");
    if (scene.render.view != "final") refuse("/render/view", "the debug view '" + scene.render.view + "' is");
    if (scene.output.format != "png" && scene.output.format != "pfm")
        refuse("/output/format", "the format '" + scene.output.format + "' is");
    if (scene.output.bit_depth != 8) refuse("/output/bit_depth", "16 bits a channel are");
    if (scene.output.solids != Solids::emission) refuse("/output/solids", "lit solids are");
    if (scene.output.tonemap == "tony") refuse("/output/tonemap", "the tone map 'tony' is");
    return problems;
}

}  // namespace penumbra
