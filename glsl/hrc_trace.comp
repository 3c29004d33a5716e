// Reads distance, material and, above level 0, the level below; writes a low level's ray pieces, each from a lattice
// point to one of the next plane. Even rays are two of the level below end to end, which is exact; odd ones are traced.
// One thread is a point's even ray and the odd one after it, or at level 0 one ray.
#version 430 core
#include "cascade.h"
#include "hrc.h"
#include "lib/march.glsl"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D pieces_image;
layout(binding = kHrcPiecesUnit) uniform sampler2D lower_texture;

#include "lib/hrc.glsl"

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    int row = id.x;
    int plane = plane_of(id.y);
    int job = id.y - plane * params.jobs;
    int slot = plane * params.rays;

    // A loop and no branch: llvmpipe runs both sides of a branch.
    for (int i = 0; i < params.compose; ++i) {
        vec4 near = lower_piece(lower_texture, 2 * plane, job, row);
        vec4 far = lower_piece(lower_texture, 2 * plane + 1, job, row + params.climb * job - params.stride / 2);
        imageStore(pieces_image, ivec2(row, slot + 2 * job), after(near, far));
    }
    int ray = params.compose != 0 ? 2 * job + 1 : job;
    if (ray >= params.rays) return;
    vec2 p = params.first + params.along * float(plane * params.stride) + params.across * float(row);
    vec2 d = params.along * float(params.stride) + params.across * float(params.climb * ray - params.stride);
    float size = length(d);
    int budget = kMarchBudget;
    vec3 radiance;
    int fate = march(p, d / size, 0.0, size, params.domain, params.border, budget, radiance);
    imageStore(pieces_image, ivec2(row, slot + ray), vec4(radiance, fate == kRayBlocked ? 0.0 : 1.0));
}
