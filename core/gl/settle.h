// SPDX-License-Identifier: MIT
// Makes a frame's programs independent of the frames before it, for llvmpipe: where a program reads a buffer texture, Mesa leaves
// the sampler of whatever program used the slot last, and a program is compiled once for every such left-over. The same goes for buffer textures that a
// program could read but this time does not. Run before each frame, a small dispatch leaves the same in every slot.
#pragma once

#include <string>

#include "core/gl/program.h"

namespace penumbra::gl {

class SamplerSettler {
public:
    explicit SamplerSettler(const std::string& shader_dir = {});
    void settle();

private:
    ComputeProgram program_;
    Texture2D source_, sum_;
    BufferTexture nothing_;
};

}  // namespace penumbra::gl
