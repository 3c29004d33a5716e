// Reads distance and, above level 0, the level below; writes a low level's ray pieces, each from a lattice point to one of the
// next plane: even rays are two of the level below end to end, which is exact; odd ones that are surely open are open; the
// others are put on a list for hrc_trace. One thread is a point's even ray and the odd one after it, or at level 0 one ray.
// A list, because llvmpipe runs through all branches: the march would be paid for by every ray.
#include "hrc.h"
#include "scene_records.h"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D pieces_image;
layout(binding = kHrcListBinding) writeonly uniform uimage2D list_image;
layout(r32ui, binding = kHrcCountBinding) uniform uimage2D count_image;
layout(HRC_FORMAT, binding = kHrcPiecesBinding) readonly uniform image2D lower_image;
layout(binding = kHrcDistanceUnit) uniform sampler2D distance_texture;

#include "lib/hrc.glsl"

layout(binding = kMediaUnit) uniform samplerBuffer media;

// Whether a ray may come through a medium on its way to p + d.
bool may_cross_media(vec2 p, vec2 d) {
    vec4 box = texelFetch(media, 1);
    return all(lessThanEqual(min(p, p + d), box.zw)) && all(greaterThanEqual(max(p, p + d), box.xy));
}

const float kHalfDiagonal = 0.7072;

float room_at(vec2 p) {
    return texelFetch(distance_texture, clamp(ivec2(floor(p)) + params.border, ivec2(0), textureSize(distance_texture, 0) - 1), 0).r;
}

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    int row = id.x;
    int plane = plane_of(id.y);
    int job = id.y - plane * params.jobs;
    int slot = plane * params.rays;

    if (params.compose != 0) {
        Piece near = lower_piece(2 * plane, job, row);
        Piece far = lower_piece(2 * plane + 1, job, row + params.climb * job - params.stride / 2);
        store_piece(ivec2(row, slot + 2 * job), after(near, far));
    }
    int ray = params.compose != 0 ? 2 * job + 1 : job;
    if (ray >= params.rays) return;
    slot += ray;
    vec2 p = params.first + params.along * float(plane * params.stride) + params.across * float(row);
    vec2 d = params.along * float(params.stride) + params.across * float(params.climb * ray - params.stride);
    float reach = 0.25 * length(d) + kHalfDiagonal;
    bool open = room_at(p + 0.25 * d) >= reach && room_at(p + 0.75 * d) >= reach;
    // What begins inside a shape is never asked for: whatever leads there is blocked. Not so within a march's last step of
    // the outline.
    bool buried = room_at(p) < -kHalfDiagonal - 0.05;
    if (kHrcMedia != 0) open = open && !may_cross_media(p, d);
    if (open || buried) {
        store_piece(ivec2(row, slot), Piece(vec3(0.0), vec3(buried ? 0.0 : 1.0)));
    } else {
        int at = int(imageAtomicAdd(count_image, ivec2(0), 1u));
        imageStore(list_image, ivec2(at & (kHrcListWidth - 1), at / kHrcListWidth), uvec4(uint(row) << 16 | uint(slot)));
    }
}
