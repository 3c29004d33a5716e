// Reads the list of rays that hrc_low could not decide, distance and material; writes those rays' pieces. One thread is one
// ray of the list.
#version 430 core
#include "cascade.h"
#include "hrc.h"
#include "lib/march.glsl"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D pieces_image;
layout(binding = kHrcListUnit) uniform usampler2D list_texture;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y * kHrcListWidth + id.x >= params.listed) return;
    uint entry = texelFetch(list_texture, id, 0).r;
    int row = int(entry >> 16);
    int slot = int(entry & 0xffffu);
    int plane = int((float(slot) + 0.5) * params.per_job);
    int ray = slot - plane * params.jobs;
    vec2 p = params.first + params.along * float(plane * params.stride) + params.across * float(row);
    vec2 d = params.along * float(params.stride) + params.across * float(params.climb * ray - params.stride);
    float size = length(d);
    int budget = kMarchBudget;
    vec3 radiance, through;
    int fate = march_through(p, d / size, 0.0, size, params.domain, params.border, budget, radiance, through);
    imageStore(pieces_image, ivec2(row, slot), vec4(radiance, fate == kRayBlocked ? 0.0 : 1.0));
    if (kSceneMedia != 0) imageStore(pieces_image, ivec2(row, slot + imageSize(pieces_image).y / 2), vec4(through, 1.0));
    report_lost_rays();
}
