// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/gl/program.h"
#include "core/passes/frame.h"
#include "core/passes/scene_buffers.h"
#include "core/plan/plan.h"

namespace penumbra {

// Holographic radiance cascades, one quadrant of directions at a time. Every step needs the scene buffers bound.
class HrcPass {
public:
    explicit HrcPass(const std::string& shader_dir);

    // The ray pieces of one level of a quadrant, from distance and material (low levels) and the level below.
    // Reads and appends to `pieces`, [n] being level n. One invocation per point of a plane and ray of the level below.
    PassWork pieces(const Plan& plan, const HrcQuadrant& quadrant, const DistanceField& field, const PassSettings& settings,
                    std::vector<gl::Texture2D>& pieces);
    // The fluences of level n from those of level n + 1 (none at the top). One invocation per point and cone.
    PassWork merge(const Plan& plan, const HrcQuadrant& quadrant, int level, const std::vector<gl::Texture2D>& pieces,
                   const gl::Texture2D* upper, const PassSettings& settings, gl::Texture2D& out);
    // An empty sum, which knows what lattice points are in free space; one invocation per lattice point in the view.
    PassWork clear(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& sum);
    // Adds level 0's fluences to those of the quadrants before; one invocation per lattice point in the view.
    PassWork gather(const Plan& plan, const HrcQuadrant& quadrant, const gl::Texture2D& fluence, const PassSettings& settings,
                    gl::Texture2D& sum);
    // Writes the mean radiance of each pixel, one invocation per pixel.
    PassWork finish(const Plan& plan, const DistanceField& field, const gl::Texture2D& sum, const PassSettings& settings,
                    gl::Texture2D& out);

private:
    // Programs that read images have the images' format in them.
    struct ByFormat {
        ByFormat(const std::string& name, const std::string& shader_dir);
        gl::ComputeProgram& of(const Plan& plan) {
            return (plan.half_floats ? half : full).of(plan.hrc.coloured ? gl::ShaderConstants{{"kHrcMedia", 1}} : gl::ShaderConstants{});
        }
        gl::ProgramForms full, half;
    };

    ByFormat low_;
    gl::ProgramForms trace_;
    ByFormat extend_;
    ByFormat merge_;
    gl::ComputeProgram clear_;
    gl::ComputeProgram gather_;
    gl::ComputeProgram blur_;
    gl::ComputeProgram spread_;
};

}  // namespace penumbra
