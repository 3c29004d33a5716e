// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/gl/program.h"
#include "core/gl/storage_buffer.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"
#include "glsl/delta.h"

namespace penumbra {

// Light of point, spot and directional lights, with exact shadows: lists of what may stand between each tile and each light,
// then a test of each list's pieces. Keeps its buffers from frame to frame.
class DeltaPass {
public:
    explicit DeltaPass(const std::string& shader_dir);

    // Reads the distance. Writes what the lights add to the mean radiance of each free pixel, rgba32f, of plan.lit.
    PassWork pixels(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& out);

    // Adds to what the floor sends up what it sends up of the lights; the textures of the floor are bound (FloorPass).
    PassWork on_floor(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& sent);

    // Writes the irradiance of the elements of surfaces into an image of kDeltaNodeRow columns. `jobs` and `nodes` as
    // glsl/exact.h has them, for tiles of kDeltaTile from `origin` on.
    struct SurfacePart {
        glm::ivec2 origin, area;
        const gl::StorageBuffer& jobs;
        const gl::BufferTexture& nodes;
        int job_count;
    };
    PassWork surfaces(const Plan& plan, const SurfacePart& part, gl::Texture2D& out);

private:
    struct Lists;
    PassWork run(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& out, bool on_floor);
    int make_lists(const Plan& plan, glm::ivec2 origin, glm::ivec2 area, Lists& lists);
    template <class Dispatch>
    int in_slices(const Lists& lists, int samples, glsl::DeltaParams params, const Dispatch& dispatch);

    gl::ComputeProgram lists_;
    gl::ProgramForms pixels_;
    gl::ComputeProgram nodes_;
    gl::StorageBuffer coarse_heads_, coarse_entries_, heads_, entries_, counters_;
};

}  // namespace penumbra
