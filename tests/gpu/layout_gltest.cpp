// SPDX-License-Identifier: MIT
// What GLSL and C++ share lies where both think it lies.
#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/device_error.h"
#include "core/gl/program.h"
#include "glsl/cascade.h"
#include "glsl/closed.h"
#include "glsl/compose.h"
#include "glsl/delta.h"
#include "glsl/distance.h"
#include "glsl/exact.h"
#include "glsl/floor.h"
#include "glsl/hrc.h"
#include "glsl/jump.h"
#include "glsl/loop_probe.h"
#include "glsl/lone.h"
#include "glsl/reference.h"
#include "glsl/rc_fix.h"
#include "glsl/lone.h"
#include "glsl/resolve.h"
#include "tests/gpu/shared_context.h"

namespace penumbra::test {
namespace {

using Offsets = std::map<std::string, std::size_t>;

// A program, its parameters field by field, and its group.
struct Layout {
    const char* shader;
    std::size_t bytes;
    Offsets fields;
    int group_x, group_y;
};

#define FIELD(Type, name) {#name, offsetof(glsl::Type, name)}

Offsets jump_fields() {
    return {FIELD(JumpParams, origin), FIELD(JumpParams, extent), FIELD(JumpParams, step),
            FIELD(JumpParams, pad0),   FIELD(JumpParams, pad1),   FIELD(JumpParams, pad2)};
}

Offsets hrc_fields() {
    return {FIELD(HrcParams, origin), FIELD(HrcParams, extent), FIELD(HrcParams, border),
            FIELD(HrcParams, rows), FIELD(HrcParams, stride), FIELD(HrcParams, climb),
            FIELD(HrcParams, jobs), FIELD(HrcParams, per_job), FIELD(HrcParams, rays),
            FIELD(HrcParams, lower_planes), FIELD(HrcParams, lower_rays),
            FIELD(HrcParams, compose), FIELD(HrcParams, first_plane), FIELD(HrcParams, cones),
            FIELD(HrcParams, upper_planes), FIELD(HrcParams, upper_cones),
            FIELD(HrcParams, upper_first), FIELD(HrcParams, piece_step),
            FIELD(HrcParams, ray_step), FIELD(HrcParams, leap), FIELD(HrcParams, own_terms),
            FIELD(HrcParams, points), FIELD(HrcParams, corner), FIELD(HrcParams, row_step),
            FIELD(HrcParams, column_step), FIELD(HrcParams, row_border),
            FIELD(HrcParams, is_first), FIELD(HrcParams, listed), FIELD(HrcParams, pad0),
            FIELD(HrcParams, first), FIELD(HrcParams, along), FIELD(HrcParams, across),
            FIELD(HrcParams, first_point), FIELD(HrcParams, domain), FIELD(HrcParams, cell),
            FIELD(HrcParams, blur), FIELD(HrcParams, pad1), FIELD(HrcParams, pad2)};
}

Offsets exact_fields() {
    return {FIELD(ExactParams, origin), FIELD(ExactParams, extent), FIELD(ExactParams, canvas),
            FIELD(ExactParams, border), FIELD(ExactParams, tiles), FIELD(ExactParams, parent_tiles),
            FIELD(ExactParams, first_row), FIELD(ExactParams, tile_px), FIELD(ExactParams, parent_ratio),
            FIELD(ExactParams, sectors), FIELD(ExactParams, largest_cell), FIELD(ExactParams, told),
            FIELD(ExactParams, tan_half), FIELD(ExactParams, sky_kind), FIELD(ExactParams, sky),
            FIELD(ExactParams, sky_nodes), FIELD(ExactParams, cell), FIELD(ExactParams, level),
            FIELD(ExactParams, first_point), FIELD(ExactParams, tile_points),
            FIELD(ExactParams, first_count), FIELD(ExactParams, capacity), FIELD(ExactParams, continues),
            FIELD(ExactParams, light_scale), FIELD(ExactParams, tolerance), FIELD(ExactParams, kink_cell),
            FIELD(ExactParams, floor_share), FIELD(ExactParams, ask_first), FIELD(ExactParams, strict_dark),
            FIELD(ExactParams, first_ask), FIELD(ExactParams, pad1), FIELD(ExactParams, root_counts),
            FIELD(ExactParams, root_lights), FIELD(ExactParams, wide), FIELD(ExactParams, jobs),
            FIELD(ExactParams, list_origin), FIELD(ExactParams, window),
            FIELD(ExactParams, fill_first), FIELD(ExactParams, fill_row), FIELD(ExactParams, pad7), FIELD(ExactParams, fill_size), FIELD(ExactParams, pad8), FIELD(ExactParams, most)};
}

Offsets delta_fields() {
    return {FIELD(DeltaParams, origin), FIELD(DeltaParams, extent), FIELD(DeltaParams, border),
            FIELD(DeltaParams, tiles), FIELD(DeltaParams, parent_tiles), FIELD(DeltaParams, list_origin),
            FIELD(DeltaParams, tile_px), FIELD(DeltaParams, parent_ratio), FIELD(DeltaParams, lights),
            FIELD(DeltaParams, first_light), FIELD(DeltaParams, end_light), FIELD(DeltaParams, capacity),
            FIELD(DeltaParams, first_row), FIELD(DeltaParams, jobs), FIELD(DeltaParams, root_counts),
            FIELD(DeltaParams, adds), FIELD(DeltaParams, least_distance), FIELD(DeltaParams, pad0),
            FIELD(DeltaParams, pad1)};
}

Offsets compose_fields() {
    return {FIELD(ComposeParams, origin),       FIELD(ComposeParams, extent),
            FIELD(ComposeParams, border),       FIELD(ComposeParams, antialias),
            FIELD(ComposeParams, levels),      FIELD(ComposeParams, floor_albedo),
            FIELD(ComposeParams, exposure),     FIELD(ComposeParams, radiance_scale),
            FIELD(ComposeParams, white),        FIELD(ComposeParams, has_shapes),
            FIELD(ComposeParams, first_pixel),  FIELD(ComposeParams, first_lit)};
}

std::vector<Layout> layouts() {
    return {
        {"distance.comp", sizeof(glsl::DistanceParams),
         {FIELD(DistanceParams, origin), FIELD(DistanceParams, extent), FIELD(DistanceParams, border),
          FIELD(DistanceParams, first_shape), FIELD(DistanceParams, end_shape), FIELD(DistanceParams, continues),
          FIELD(DistanceParams, far_px), FIELD(DistanceParams, jobs), FIELD(DistanceParams, pad0)},
         glsl::kDistanceGroupX, glsl::kDistanceGroupY},
        {"jump_seed.comp", sizeof(glsl::JumpParams), jump_fields(), glsl::kJumpGroupX, glsl::kJumpGroupY},
        {"jump_flood.comp", sizeof(glsl::JumpParams), jump_fields(), glsl::kJumpGroupX, glsl::kJumpGroupY},
        {"jump_merge.comp", sizeof(glsl::JumpParams), jump_fields(), glsl::kJumpGroupX, glsl::kJumpGroupY},
        {"near_seeds.comp", sizeof(glsl::JumpParams), jump_fields(), glsl::kJumpGroupX, glsl::kJumpGroupY},
        {"near_columns.comp", sizeof(glsl::JumpParams), jump_fields(), glsl::kJumpGroupX, glsl::kJumpGroupY},
        {"near_merge.comp", sizeof(glsl::JumpParams), jump_fields(), glsl::kJumpGroupX, glsl::kJumpGroupY},
        {"cascade.comp", sizeof(glsl::CascadeParams),
         {FIELD(CascadeParams, origin), FIELD(CascadeParams, extent), FIELD(CascadeParams, probes),
          FIELD(CascadeParams, upper_probes), FIELD(CascadeParams, border), FIELD(CascadeParams, tiles),
          FIELD(CascadeParams, upper_tiles), FIELD(CascadeParams, upper_texel), FIELD(CascadeParams, first_probe),
          FIELD(CascadeParams, upper_first), FIELD(CascadeParams, domain), FIELD(CascadeParams, offset_cos),
          FIELD(CascadeParams, offset_sin), FIELD(CascadeParams, sky), FIELD(CascadeParams, spacing),
          FIELD(CascadeParams, upper_spacing), FIELD(CascadeParams, start), FIELD(CascadeParams, end),
          FIELD(CascadeParams, group_angle), FIELD(CascadeParams, is_last), FIELD(CascadeParams, sky_first),
          FIELD(CascadeParams, pad0)},
         glsl::kCascadeGroupX, glsl::kCascadeGroupY},
        {"rc_fix.comp", sizeof(glsl::RcFixParams),
         {FIELD(RcFixParams, origin), FIELD(RcFixParams, extent), FIELD(RcFixParams, probes), FIELD(RcFixParams, upper_probes),
          FIELD(RcFixParams, border), FIELD(RcFixParams, tiles), FIELD(RcFixParams, upper_tiles), FIELD(RcFixParams, upper_texel),
          FIELD(RcFixParams, first_probe), FIELD(RcFixParams, upper_first), FIELD(RcFixParams, domain),
          FIELD(RcFixParams, offset_cos), FIELD(RcFixParams, offset_sin), FIELD(RcFixParams, sky), FIELD(RcFixParams, spacing),
          FIELD(RcFixParams, upper_spacing), FIELD(RcFixParams, start), FIELD(RcFixParams, end), FIELD(RcFixParams, group_angle),
          FIELD(RcFixParams, longest), FIELD(RcFixParams, pad0), FIELD(RcFixParams, sky_first)},
         glsl::kRcFixGroupX, glsl::kRcFixGroupY},
        {"resolve.comp", sizeof(glsl::ResolveParams),
         {FIELD(ResolveParams, origin), FIELD(ResolveParams, extent), FIELD(ResolveParams, probes),
          FIELD(ResolveParams, tiles), FIELD(ResolveParams, texel), FIELD(ResolveParams, first_probe),
          FIELD(ResolveParams, spacing), FIELD(ResolveParams, aligned), FIELD(ResolveParams, first_pixel)},
         glsl::kResolveGroupX, glsl::kResolveGroupY},
        {"closed.comp", sizeof(glsl::ClosedParams),
         {FIELD(ClosedParams, origin), FIELD(ClosedParams, extent), FIELD(ClosedParams, canvas), FIELD(ClosedParams, border),
          FIELD(ClosedParams, tile), FIELD(ClosedParams, pad0), FIELD(ClosedParams, pad1), FIELD(ClosedParams, pad2)},
         glsl::kClosedGroupX, glsl::kClosedGroupY},
        {"lone.comp", sizeof(glsl::LoneParams),
         {FIELD(LoneParams, origin), FIELD(LoneParams, extent), FIELD(LoneParams, border), FIELD(LoneParams, first_pixel),
          FIELD(LoneParams, domain), FIELD(LoneParams, sky)},
         glsl::kLoneGroupX, glsl::kLoneGroupY},
        {"reference.comp", sizeof(glsl::ReferenceParams),
         {FIELD(ReferenceParams, origin), FIELD(ReferenceParams, extent), FIELD(ReferenceParams, border),
          FIELD(ReferenceParams, shape_count), FIELD(ReferenceParams, ray_count), FIELD(ReferenceParams, first_ray),
          FIELD(ReferenceParams, end_ray), FIELD(ReferenceParams, sky_first), FIELD(ReferenceParams, is_last),
          FIELD(ReferenceParams, domain), FIELD(ReferenceParams, sky), FIELD(ReferenceParams, first_pixel),
          FIELD(ReferenceParams, pad0)},
         glsl::kReferenceGroupX, glsl::kReferenceGroupY},
        {"exact_lists.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactGroupX, glsl::kExactGroupY},
        {"exact_solve.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactSolveGroupX, glsl::kExactGroupY},
        {"exact_split.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactGroupX, glsl::kExactGroupY},
        {"exact_jobs.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactGroupX, glsl::kExactGroupY},
        {"exact_mean.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactGroupX, glsl::kExactGroupY},
        {"exact_fill.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactGroupX, glsl::kExactGroupY},
        {"exact_reflect.comp", sizeof(glsl::ExactParams), exact_fields(), glsl::kExactGroupX, glsl::kExactGroupY},
        {"delta_lists.comp", sizeof(glsl::DeltaParams), delta_fields(), glsl::kDeltaGroupX, glsl::kDeltaGroupY},
        {"delta.comp", sizeof(glsl::DeltaParams), delta_fields(), glsl::kDeltaGroupX, glsl::kDeltaGroupY},
        {"floor.comp", sizeof(glsl::FloorParams),
         {FIELD(FloorParams, origin), FIELD(FloorParams, extent), FIELD(FloorParams, first_pixel), FIELD(FloorParams, radiance_scale),
          FIELD(FloorParams, pad0)},
         glsl::kFloorGroupX, glsl::kFloorGroupY},
        {"delta_nodes.comp", sizeof(glsl::DeltaParams), delta_fields(), glsl::kDeltaGroupX, glsl::kDeltaGroupY},
        {"hrc_low.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_low_half.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_trace.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_extend.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_extend_half.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_merge.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_merge_half.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_clear.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_gather.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_blur.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"hrc_spread.comp", sizeof(glsl::HrcParams), hrc_fields(), glsl::kHrcGroupX, glsl::kHrcGroupY},
        {"compose.comp", sizeof(glsl::ComposeParams), compose_fields(), glsl::kComposeGroupX, glsl::kComposeGroupY},
        {"linear.comp", sizeof(glsl::ComposeParams), compose_fields(), glsl::kComposeGroupX, glsl::kComposeGroupY},
        {"loop_probe.comp", sizeof(glsl::LoopProbeParams),
         {FIELD(LoopProbeParams, origin), FIELD(LoopProbeParams, iterations), FIELD(LoopProbeParams, pad0)},
         8, 1},
    };
}

// What the driver says of the members of the parameter block.
Offsets reflected(GLuint program) {
    Offsets result;
    GLint count = 0;
    glGetProgramInterfaceiv(program, GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; ++i) {
        const GLenum wanted[] = {GL_BLOCK_INDEX, GL_OFFSET};
        GLint values[2] = {-1, -1};
        glGetProgramResourceiv(program, GL_UNIFORM, static_cast<GLuint>(i), 2, wanted, 2, nullptr, values);
        if (values[0] < 0) continue;
        char name[128] = {};
        glGetProgramResourceName(program, GL_UNIFORM, static_cast<GLuint>(i), sizeof name, nullptr, name);
        const std::string full = name;
        result[full.substr(full.rfind('.') + 1)] = static_cast<std::size_t>(values[1]);
    }
    return result;
}

TEST(Layout, EveryFieldLiesAtTheSameOffsetInGlslAndCpp) {
    shared_context();
    for (const Layout& layout : layouts()) {
        const gl::ComputeProgram program(layout.shader, layout.bytes, shader_dir());
        EXPECT_EQ(reflected(program.id()), layout.fields) << layout.shader;
    }
}

TEST(Layout, GroupSizesAreTheHeaders) {
    const gl::Context& context = shared_context();
    for (const Layout& layout : layouts()) {
        const gl::ComputeProgram program(layout.shader, layout.bytes, shader_dir());
        GLint group[3] = {};
        glGetProgramiv(program.id(), GL_COMPUTE_WORK_GROUP_SIZE, group);
        EXPECT_EQ(group[0], layout.group_x) << layout.shader;
        EXPECT_EQ(group[1], layout.group_y) << layout.shader;
        EXPECT_EQ(group[2], 1) << layout.shader;
        EXPECT_LE(group[0] * group[1], context.info().max_group_invocations);
    }
}

TEST(Layout, ParametersOfAnotherSizeAreRefused) {
    shared_context();
    try {
        const gl::ComputeProgram program("distance.comp", sizeof(glsl::DistanceParams) + 16, shader_dir());
        FAIL() << "built with parameters of the wrong size";
    } catch (const DeviceError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("distance.comp"), std::string::npos) << what;
        EXPECT_NE(what.find(std::to_string(sizeof(glsl::DistanceParams))), std::string::npos) << what;
        EXPECT_NE(what.find(std::to_string(sizeof(glsl::DistanceParams) + 16)), std::string::npos) << what;
    }
}

}  // namespace
}  // namespace penumbra::test
