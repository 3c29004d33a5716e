// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/floor/response.h"
#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"

namespace penumbra {

// Light as it arrives at pixels, each texture one texel where it is the same everywhere.
struct ArrivingLight {
    const gl::Texture2D& radiance;  // mean radiance
    const gl::Texture2D& lights;    // what lights without a size add to it
    const gl::Texture2D& moment_x;  // mean of radiance times direction
    const gl::Texture2D& moment_y;
};

// What a floor that is more than an albedo sends up. Keeps the last gloss's table of responses.
class FloorPass {
public:
    explicit FloorPass(const std::string& shader_dir);

    // Of the pixels of plan.lit: albedo and normal from the scene's pictures, on the host. Until the next call these are the floor.
    void prepare(const Plan& plan, const Scene& scene, const PassSettings& settings);
    // Binds what `prepare` made, for programs with glsl/lib/floor.glsl.
    void bind() const;

    // Writes what the floor sends up, rgba32f, of plan.lit. Where it has relief, what it sends up of lights without a size is added
    // after (DeltaPass::on_floor).
    PassWork run(const Plan& plan, const ArrivingLight& light, const PassSettings& settings, gl::Texture2D& out);

    void give_back(const PassSettings& settings);

private:
    gl::ProgramForms program_;
    gl::Texture2D albedo_, normal_;
    std::optional<Gloss> gloss_;  // whose table this is
    gl::BufferTexture table_;
};

}  // namespace penumbra
