// Reads ray pieces and the fluences of the level above; writes this level's fluence through each cone, for its even or
// its odd planes. One thread is a lattice point and a cone.
// Read as images: on llvmpipe that is two to three times as fast as fetching from a texture.
#include "hrc.h"
#include "scene_records.h"
#include "lib/hrc_media.glsl"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D fluence_image;
layout(HRC_FORMAT, binding = kHrcPiecesBinding) readonly uniform image2D pieces_image;
layout(HRC_FORMAT, binding = kHrcUpperBinding) readonly uniform image2D upper_image;
layout(binding = kSkySectorsUnit) uniform samplerBuffer cone_table;  // rgb: the sky in a cone, a: its angle

// Each half of a cone leaves by its nearer ray, but for this share by the farther one: all of it by the nearer would draw light
// towards the directions of the lowest levels' rays (docs/decisions/0012).
const float kFarShare = 0.125;

int plane_of(int job) { return int((float(job) + 0.5) * params.per_job); }

// What lies ahead of a ray: its piece, then what arrives at its end through two cones of the level above, or the sky.
vec3 along_ray(int plane, int ray, int row, int upper_cone, vec4 sky0, vec4 sky1, vec2 weight) {
    ivec2 piece_at = ivec2(row, (params.piece_step * plane + params.first_plane) * params.lower_rays + params.ray_step * ray);
    vec4 piece = imageLoad(pieces_image, piece_at);
    vec3 through = vec3(piece.a);
    if (kHrcMedia != 0) through = imageLoad(pieces_image, piece_at + ivec2(0, imageSize(pieces_image).y / 2)).rgb;
    int end = row + params.leap * (params.climb * ray - params.stride);
    int inside_plane = min(plane + 1, max(params.upper_planes - 1, 0));
    int inside_row = clamp(end, 0, params.rows - 1);
    ivec2 at = ivec2(inside_row, inside_plane * params.upper_cones + upper_cone);
    bool inside = plane + 1 < params.upper_planes && end == inside_row;
    vec3 ahead0 = imageLoad(upper_image, at).rgb;
    vec3 ahead1 = imageLoad(upper_image, at + ivec2(0, 1)).rgb;
    vec3 ahead = weight.x * (inside ? ahead0 : sky0.rgb) + weight.y * (inside ? ahead1 : sky1.rgb);
    return dot(weight, vec2(sky0.a, sky1.a)) * piece.rgb + through * ahead;
}

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    int row = id.x;
    int plane = plane_of(id.y);  // of this parity
    int cone = id.y - plane * params.jobs;

    vec4 sky0 = texelFetch(cone_table, params.upper_first + 2 * cone);
    vec4 sky1 = texelFetch(cone_table, params.upper_first + 2 * cone + 1);
    vec3 fluence = along_ray(plane, cone, row, 2 * cone, sky0, sky1, vec2(1.0 - kFarShare, kFarShare)) +
                   along_ray(plane, cone + 1, row, 2 * cone, sky0, sky1, vec2(kFarShare, 1.0 - kFarShare));
    if (params.own_terms != 0) fluence *= 0.5;
    for (int s = 0; s < params.own_terms; ++s)
        fluence += 0.5 * imageLoad(upper_image, ivec2(row, plane * params.upper_cones + 2 * cone + s)).rgb;
    imageStore(fluence_image, ivec2(row, (2 * plane + params.first_plane) * params.cones + cone), vec4(fluence, 1.0));
}
