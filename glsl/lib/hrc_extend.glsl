// Reads the ray pieces of the level below; writes a level's: even rays are two pieces end to end, odd ones the mean of the two
// ways round by a neighbouring point; even ones take a share of the ways round by theirs too, so that they are not the thinner
// (docs/decisions/0013). One thread is a point's even ray and the odd one after it.
#include "hrc.h"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D pieces_image;
layout(HRC_FORMAT, binding = kHrcPiecesBinding) readonly uniform image2D lower_image;

#include "lib/hrc.glsl"

const float kSpread = 0.25;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    int row = id.x;
    int plane = plane_of(id.y);
    int job = id.y - plane * params.jobs;
    ivec2 texel = ivec2(row, plane * params.rays + 2 * job);
    int middle = row + params.climb * job - params.stride / 2;

    Piece near = lower_piece(2 * plane, job, row);
    Piece far = lower_piece(2 * plane + 1, job, middle);
    Piece near_next = lower_piece(2 * plane, min(job + 1, params.jobs - 1), row);
    Piece near_before = lower_piece(2 * plane, max(job - 1, 0), row);
    Piece before = after(near_before, lower_piece(2 * plane + 1, min(job + 1, params.jobs - 1), middle - params.climb));
    Piece next = after(near_next, lower_piece(2 * plane + 1, max(job - 1, 0), middle + params.climb));
    bool has_both = job > 0 && job + 1 < params.jobs;
    store_piece(texel, mixed(after(near, far), mixed(before, next, 0.5), has_both ? kSpread : 0.0));
    if (job + 1 >= params.jobs) return;
    Piece steep = lower_piece(2 * plane + 1, job + 1, middle);
    Piece flat_far = lower_piece(2 * plane + 1, job, middle + params.climb);
    store_piece(texel + ivec2(0, 1), mixed(after(near, steep), after(near_next, flat_far), 0.5));
}
