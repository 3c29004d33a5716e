// Reads the ray pieces of the level below; writes a level's: even rays are two pieces end to end, odd ones the mean of the two
// ways round by a neighbouring point. One thread is a point's even ray and the odd one after it.
#version 430 core
#include "hrc.h"

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
    ivec2 texel = ivec2(row, plane * params.rays + 2 * job);
    int middle = row + params.climb * job - params.stride / 2;

    vec4 near = lower_piece(lower_texture, 2 * plane, job, row);
    vec4 far = lower_piece(lower_texture, 2 * plane + 1, job, middle);
    imageStore(pieces_image, texel, after(near, far));
    if (job + 1 >= params.jobs) return;
    vec4 near_next = lower_piece(lower_texture, 2 * plane, job + 1, row);
    vec4 steep = lower_piece(lower_texture, 2 * plane + 1, job + 1, middle);
    vec4 flat_far = lower_piece(lower_texture, 2 * plane + 1, job, middle + params.climb);
    imageStore(pieces_image, texel + ivec2(0, 1), 0.5 * (after(near, steep) + after(near_next, flat_far)));
}
