// SPDX-License-Identifier: MIT
#pragma once

#include "core/gl/handles.h"
#include "core/plan/pack.h"
#include "core/plan/plan.h"

namespace penumbra {

// The packed scene on the device, behind the texture units of glsl/scene_records.h.
class SceneBuffers {
public:
    SceneBuffers(const PackedScene& scene, const Sky& sky, const Plan& plan);

    void bind() const;
    bool has_sky_table() const { return has_sky_table_; }
    std::size_t bytes() const;

private:
    gl::BufferTexture shapes_;
    gl::BufferTexture edges_;
    gl::BufferTexture texels_;
    gl::BufferTexture media_;
    gl::BufferTexture sky_;  // one sector per direction of each cascade; only for gradients
    bool has_sky_table_ = false;
};

}  // namespace penumbra
