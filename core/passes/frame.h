// SPDX-License-Identifier: MIT
// What one render passes from step to step.
#pragma once

#include <cstddef>
#include <utility>

#include "core/gl/handles.h"
#include "core/gl/shader_source.h"
#include "core/gl/texture_pool.h"
#include "core/plan/plan.h"

namespace penumbra {

// Signed distance to the nearest shape, and which shape, on the grid of the plan.
struct DistanceField {
    gl::Texture2D distance;  // r32f, px
    gl::Texture2D material;  // r32i, shape index or -1
};

// What every pass of a frame shares: how much one dispatch may cover before the pass is cut into bands (0: all), and where
// its textures come from.
struct PassSettings {
    std::size_t distance_iterations = 0;  // pixels times shapes
    std::size_t rays = 0;
    std::size_t pixels = 0;
    gl::TexturePool* textures = nullptr;  // none: made anew each time
    bool slow_clears = false;             // to clear a texture takes longer than to write all of it: a GPU that hardly draws

    gl::Texture2D take(GLenum format, glm::ivec2 size, gl::Filter filter = gl::Filter::nearest) const {
        return textures != nullptr ? textures->take(format, size, filter) : gl::Texture2D(format, size, filter);
    }
    void give(gl::Texture2D texture) const {
        if (textures != nullptr) textures->give(std::move(texture));
    }
};

// For programs that read the scene (glsl/lib/scene.glsl): the kinds of shapes that it has. None: made for all.
inline gl::ShaderConstants scene_constants(const ProgramNeeds& needs) {
    if (needs.general) return {};
    return {{"kSceneEllipses", needs.ellipses ? 1 : 0}, {"kSceneOutlines", needs.outlines ? 1 : 0}, {"kSceneBitmaps", needs.bitmaps ? 1 : 0},
            {"kSceneGradients", needs.gradients ? 1 : 0}};
}

// For programs that meet surfaces and media as well (glsl/lib/surface_light.glsl, media.glsl).
inline gl::ShaderConstants light_constants(const ProgramNeeds& needs, gl::ShaderConstants constants = {}) {
    if (needs.surfaces) constants.emplace_back("kSceneSurfaces", 1);
    if (needs.steps) constants.emplace_back("kCountSteps", 1);
    if (needs.media) constants.emplace_back("kSceneMedia", 1);
    return constants;
}
inline gl::ShaderConstants march_constants(const ProgramNeeds& needs) { return light_constants(needs, scene_constants(needs)); }

// What a pass reports of its run.
struct PassWork {
    int dispatches = 0;
    std::size_t rays = 0;
    std::size_t bytes = 0;  // written to textures
    std::size_t points = 0;  // solved
};

}  // namespace penumbra
