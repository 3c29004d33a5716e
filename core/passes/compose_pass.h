// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/film/tone_lut.h"
#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace penumbra {

// Reads mean radiance, distance and material, with the scene buffers bound. Writes the picture: rgba8 or rgba16 for
// display (coverage, exposure, tone curve, sRGB, dither) or rgba32f linear. One invocation per pixel.
class ComposePass {
public:
    explicit ComposePass(const std::string& shader_dir);
    // What the tone map "tony" looks up.
    void set_tone_lut(const ToneLut& lut);

    // What solid pixels show beside their emission, until it is set again: see lit_solids().
    void set_lit(gl::Texture2D lit) { lit_ = std::move(lit); }

    // Rows `first_row` and on, as many as `out` has, for display: the format of `out` says how many codes there are.
    PassWork display(const Plan& plan, const Scene& scene, double exposure, const gl::Texture2D& radiance, const DistanceField& field,
                     const PassSettings& settings, int first_row, gl::Texture2D& out);
    // The same rows as linear values, with alpha 1 where free.
    PassWork linear(const Plan& plan, const Scene& scene, const gl::Texture2D& radiance, const DistanceField& field,
                    const PassSettings& settings, int first_row, gl::Texture2D& out);

private:
    using Curve = std::array<int, 3>;  // tone map, look, dither
    gl::ComputeProgram& display_for(const OutputSettings& output);

    std::string shader_dir_;
    std::map<Curve, gl::ComputeProgram> display_;
    gl::ComputeProgram linear_;
    gl::Texture2D tone_lut_;
    gl::Texture2D lit_;
};

}  // namespace penumbra
