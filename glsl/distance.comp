// Reads the packed scene and the lists of near shapes; writes the signed distance to the union of the shapes asked and the topmost one that
// covers the pixel (else the nearest one, -1 without shapes). One thread is one grid pixel.
#version 430 core
#include "distance.h"
#include "lib/scene.glsl"

layout(local_size_x = kDistanceGroupX, local_size_y = kDistanceGroupY) in;
layout(std140, binding = kDistanceParamsBinding) uniform Params { DistanceParams params; };
layout(binding = kTileJobsUnit) uniform isamplerBuffer tile_jobs;
layout(binding = kTileShapesUnit) uniform isamplerBuffer tile_shapes;
layout(r32f, binding = kDistanceImageBinding) uniform image2D distance_image;
layout(r32i, binding = kMaterialImageBinding) uniform iimage2D material_image;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    ivec2 range = ivec2(params.first_shape, params.end_shape);
    if (kDistanceByTiles != 0) {
        if (pixel.y >= params.jobs) return;
        ivec4 job = texelFetch(tile_jobs, pixel.y);
        pixel = job.xy + ivec2(pixel.x % kDistanceTile, pixel.x / kDistanceTile);
        range = job.zw;
    }
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec2 p = vec2(pixel - params.border) + 0.5;

    float nearest = params.far_px;
    int material = -1;
    if (params.continues != 0) {
        nearest = imageLoad(distance_image, pixel).r;
        material = imageLoad(material_image, pixel).r;
    }
    for (int k = range.x; k < range.y; ++k) {
        int i = kDistanceByTiles != 0 ? texelFetch(tile_shapes, k).r : k;
        float d = shape_distance(i, p, nearest);
        // Later shapes lie on top of earlier ones wherever both cover the point, and where their outlines coincide.
        if (d <= 0.0 || d <= nearest) material = i;
        nearest = min(nearest, d);
    }
    imageStore(distance_image, pixel, vec4(nearest));
    imageStore(material_image, pixel, ivec4(material));
}
