// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include "core/film/tone_lut.h"
#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace penumbra {

// What a picture is composed of.
struct FrameLight {
    const gl::Texture2D* radiance;  // mean radiance
    const gl::Texture2D* lights;    // what lights without a size add to it
    const DistanceField& field;
    bool of_floor = false;          // the radiance is what the floor sends up, of plan.lit; there is nothing to add or multiply
};

// Reads light, distance and material, with the scene buffers bound. Writes the picture: rgba8 or rgba16 for display (coverage, exposure,
// tone curve, sRGB, dither) or rgba32f linear. One invocation per pixel.
class ComposePass {
public:
    explicit ComposePass(const std::string& shader_dir);
    // What the tone map "tony" looks up.
    void set_tone_lut(const ToneLut& lut);
    // What solid pixels show beside their emission, until it is set again: see lit_solids().
    void set_lit(gl::Texture2D lit) { lit_ = std::move(lit); }

    // The part of the canvas that begins at `first` and is as large as `out`, for display: the format of `out` says how many codes there are.
    PassWork display(const Plan& plan, const Scene& scene, double exposure, const FrameLight& light, const PassSettings& settings,
                     glm::ivec2 first, gl::Texture2D& out);
    // The same as linear values, with alpha 1 where free.
    PassWork linear(const Plan& plan, const Scene& scene, const FrameLight& light, const PassSettings& settings, glm::ivec2 first,
                    gl::Texture2D& out);

private:
    gl::ProgramForms display_;
    gl::ProgramForms linear_;
    gl::Texture2D tone_lut_;
    gl::Texture2D lit_;
};

}  // namespace penumbra
