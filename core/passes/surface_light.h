// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "core/gl/handles.h"
#include "core/passes/delta_pass.h"
#include "core/passes/exact_pass.h"
#include "core/passes/recorder.h"
#include "core/plan/plan.h"

namespace penumbra {

// What rays that are sampled find at the surfaces that they meet, where light bounces (glsl/surface_records.h).
class SurfaceLight {
public:
    SurfaceLight() = default;
    // Lets light bounce between the plan's surfaces. Throws DeviceError where there are too many.
    SurfaceLight(const Plan& plan, const Sky& sky, ExactPass& exact, DeltaPass& delta, const PassSettings& settings, Recorder& record);

    void bind() const;
    std::size_t bytes() const { return heads_.bytes() + chords_.bytes(); }

private:
    gl::BufferTexture heads_, chords_;
};

}  // namespace penumbra
