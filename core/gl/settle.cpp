// SPDX-License-Identifier: MIT
#include "core/gl/settle.h"

#include "glsl/settle.h"

namespace penumbra::gl {

SamplerSettler::SamplerSettler(const std::string& shader_dir)
    : program_("settle.comp", sizeof(glsl::SettleParams), shader_dir),
      source_(GL_R32F, {1, 1}),
      sum_(GL_RGBA32F, {glsl::kSettleGroupX, 1}),
      nothing_(GL_R32F, nullptr, 0) {
    const float zero = 0;
    source_.fill(GL_RED, GL_FLOAT, &zero);
}

void SamplerSettler::settle() {
    for (int unit = 0; unit < glsl::kSettleUnits; ++unit) {
        source_.bind_texture(unit);
        nothing_.bind_texture(unit);
    }
    sum_.bind_image(glsl::kSettleImageBinding, GL_WRITE_ONLY);
    glsl::SettleParams params{};
    params.extent = sum_.size();
    program_.dispatch(params, params.extent);
}

}  // namespace penumbra::gl
