// Reads ray pieces and the fluences of the level above; writes this level's fluence through each cone, for its even or
// its odd planes. One thread is a lattice point and a cone.
#version 430 core
#include "hrc.h"
#include "scene_records.h"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D fluence_image;
layout(binding = kHrcPiecesUnit) uniform sampler2D pieces_texture;
layout(binding = kHrcFluenceUnit) uniform sampler2D upper_texture;
layout(binding = kSkySectorsUnit) uniform samplerBuffer cone_table;  // rgb: the sky in a cone, a: its angle

int plane_of(int job) { return int((float(job) + 0.5) * params.per_job); }

// What lies ahead of a ray: its piece, then half of each neighbouring cone of the level above, or the sky.
vec3 along_ray(int plane, int ray, int row, int upper_cone) {
    vec4 piece = texelFetch(pieces_texture, ivec2(row, (params.piece_step * plane + params.first_plane) * params.lower_rays + params.ray_step * ray), 0);
    vec4 sky = texelFetch(cone_table, params.upper_first + upper_cone);
    int end = row + params.leap * (params.climb * ray - params.stride);
    int inside_plane = min(plane + 1, max(params.upper_planes - 1, 0));
    int inside_row = clamp(end, 0, params.rows - 1);
    vec3 ahead = texelFetch(upper_texture, ivec2(inside_row, inside_plane * params.upper_cones + upper_cone), 0).rgb;
    bool inside = plane + 1 < params.upper_planes && end == inside_row;
    return sky.a * piece.rgb + piece.a * (inside ? ahead : sky.rgb);
}

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    int row = id.x;
    int plane = plane_of(id.y);  // of this parity
    int cone = id.y - plane * params.jobs;

    vec3 fluence = along_ray(plane, cone, row, 2 * cone) + along_ray(plane, cone + 1, row, 2 * cone + 1);
    if (params.own_terms != 0) fluence *= 0.5;
    for (int s = 0; s < params.own_terms; ++s)
        fluence += 0.5 * texelFetch(upper_texture, ivec2(row, plane * params.upper_cones + 2 * cone + s), 0).rgb;
    imageStore(fluence_image, ivec2(row, (2 * plane + params.first_plane) * params.cones + cone), vec4(fluence, 1.0));
}
