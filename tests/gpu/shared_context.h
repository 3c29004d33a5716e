// SPDX-License-Identifier: MIT
// A bare context for tests of single passes, and the scene's way to them.
#pragma once

#include <memory>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/handles.h"
#include "core/passes/distance_pass.h"
#include "core/passes/frame.h"
#include "core/passes/jump_flood_pass.h"
#include "core/passes/near_bitmaps_pass.h"
#include "core/passes/scene_buffers.h"
#include "core/plan/plan.h"
#include "core/plan/shape_lists.h"

namespace penumbra::test {

// Made current at the first call; destroyed when all tests have run.
gl::Context& shared_context();
const std::string& shader_dir();

// One dispatch for everything.
inline constexpr PassSettings kOneSlice{};

struct Field {
    glm::ivec2 size{0};
    std::vector<float> distance;
    std::vector<int> material;
    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(size.x) + std::size_t(x); }
};
Field read_field(const DistanceField& field);

// Distance pass (with lists of near shapes, and with jump flooding, where the plan has them) of a scene.
// A plan whose passes run even where the picture is constant, and whose distances are told however far.
Plan pass_plan(Scene scene);

Field run_distance(const Scene& scene, const Plan& plan, const PassSettings& settings = kOneSlice);
Field run_distance(const Scene& scene);

}  // namespace penumbra::test
