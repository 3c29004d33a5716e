// SPDX-License-Identifier: MIT
// The FLIP difference of two pictures for low dynamic range, written from its paper:
// P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2),
// 2020.
#pragma once

#include <variant>

#include "core/image/image.h"
#include "core/scene/problem.h"

namespace penumbra {

struct FlipOptions {
    // Of the viewer. The paper's default: a 3840 pixel wide screen of 0.7 m seen from 0.7 m.
    double pixels_per_degree = 67;
};

struct Flip {
    ImageF map;       // 1 channel, 0 (no difference seen) to 1
    double mean = 0;  // of the map: the figure that is quoted
};

// 8 bits, sRGB encoded; grey counts as equal RGB, alpha is ignored. Symmetric.
std::variant<Flip, Problem> flip(const Image8& a, const Image8& b, const FlipOptions& options = {});

}  // namespace penumbra
