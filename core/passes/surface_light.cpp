// SPDX-License-Identifier: MIT
#include "core/passes/surface_light.h"

#include <string>
#include <vector>

#include "core/plan/surface_cells.h"
#include "glsl/surface_records.h"

namespace penumbra {

SurfaceLight::SurfaceLight(const Plan& plan, const Sky& sky, ExactPass& exact, DeltaPass& delta, const PassSettings& settings, Recorder& record) {
    std::vector<glm::vec4> elements;
    try {
        elements = exact.surfaces(plan, sky, settings, delta,
                                  [&](const char* name, glm::ivec2 extent, const auto& run) { record.pass(name, extent, run); });
    } catch (const TooDense& problem) {
        throw DeviceError(std::string("Bounces: ") + problem.what());
    }
    record.host("surfaces", plan.grid.size, [&] {
        const SurfaceCells cells = surface_cells(plan.exact.outline.surfaces, elements, plan.grid);
        heads_ = gl::BufferTexture(GL_RG32UI, cells.heads.data(), cells.heads.size() * sizeof(glm::uvec2));
        chords_ = gl::BufferTexture(GL_RGBA32F, cells.chords.data(), cells.chords.size() * sizeof(glm::vec4));
    });
}

void SurfaceLight::bind() const {
    if (!heads_) return;
    heads_.bind_texture(glsl::kSurfaceHeadsUnit);
    chords_.bind_texture(glsl::kSurfaceChordsUnit);
}

}  // namespace penumbra
