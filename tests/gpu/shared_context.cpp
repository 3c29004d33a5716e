// SPDX-License-Identifier: MIT
#include "tests/gpu/shared_context.h"

#include "core/plan/saving.h"

#include <gtest/gtest.h>

#include "core/plan/pack.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

struct Shared {
    gl::Context context{test_options().device};
    DistancePass distance{shader_dir()};
    JumpFloodPass jump_flood{shader_dir()};
    NearBitmapsPass near_bitmaps{shader_dir()};
};
std::unique_ptr<Shared> shared;

Shared& all() {
    if (!shared) shared = std::make_unique<Shared>();
    return *shared;
}

class DestroyContext : public testing::Environment {
public:
    void TearDown() override { shared.reset(); }
};

const testing::Environment* const kDestroyContext = testing::AddGlobalTestEnvironment(new DestroyContext);

}  // namespace

gl::Context& shared_context() { return all().context; }

const std::string& shader_dir() {
    static const std::string kFolder = test_options().shader_dir;
    return kFolder;
}

Field read_field(const DistanceField& field) {
    Field result;
    result.size = field.distance.size();
    const std::size_t count = std::size_t(result.size.x) * std::size_t(result.size.y);
    result.distance.resize(count);
    result.material.resize(count);
    field.distance.read(GL_RED, GL_FLOAT, result.distance.data());
    field.material.read(GL_RED_INTEGER, GL_INT, result.material.data());
    return result;
}

Field run_distance(const Scene& scene, const Plan& plan, const PassSettings& settings) {
    Shared& s = all();
    const PackedScene packed = pack_scene(scene, 1);
    const SceneBuffers buffers(packed, scene.sky, plan);
    buffers.bind();
    DistanceField field;
    s.distance.run(plan, packed, plan.list_shapes ? list_shapes(packed, plan) : ShapeLists(), settings, field);
    if (!plan.jump_steps.empty()) s.jump_flood.run(plan, settings, field);
    if (plan.near_bitmaps) s.near_bitmaps.run(plan, packed, settings, field);
    return read_field(field);
}

Plan pass_plan(Scene scene) {
    scene.render.keep = static_cast<std::uint32_t>(Saving::constant) | static_cast<std::uint32_t>(Saving::reach);
    return make_plan(scene, {});
}

Field run_distance(const Scene& scene) { return run_distance(scene, pass_plan(scene)); }

}  // namespace penumbra::test
