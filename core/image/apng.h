// SPDX-License-Identifier: MIT
// Animated PNG, piece by piece as its frames come: 8 bits RGB, whole frames.
#pragma once

#include <cstdint>

#include "core/image/codec.h"

namespace penumbra {

class ApngWriter {
public:
    // `frames` and `plays` (0: for ever) stand in the head, so they are known from the start.
    ApngWriter(int width, int height, std::uint32_t frames, std::uint32_t plays, double fps);

    Bytes head() const;
    Bytes frame(const Texels& pixels);  // of the size; alpha is left out
    Bytes end() const;

private:
    int width_, height_;
    std::uint32_t frames_, plays_;
    double fps_;
    std::uint32_t sequence_ = 0;
    bool first_ = true;
};

}  // namespace penumbra
