// Reads the packed scene; writes the signed distance to the union of all shapes and the topmost shape that
// covers the pixel (else the nearest one, -1 without shapes). One thread is one grid pixel.
#version 430 core
#include "distance.h"
#include "lib/scene.glsl"

layout(local_size_x = kDistanceGroupX, local_size_y = kDistanceGroupY) in;
layout(std140, binding = kDistanceParamsBinding) uniform Params { DistanceParams params; };
layout(r32f, binding = kDistanceImageBinding) uniform image2D distance_image;
layout(r32i, binding = kMaterialImageBinding) uniform iimage2D material_image;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec2 p = vec2(pixel - params.border) + 0.5;

    float nearest = params.far_px;
    int material = -1;
    if (params.continues != 0) {
        nearest = imageLoad(distance_image, pixel).r;
        material = imageLoad(material_image, pixel).r;
    }
    for (int i = params.first_shape; i < params.end_shape; ++i) {
        float d = shape_distance(i, p, nearest);
        // Later shapes lie on top of earlier ones wherever both cover the point.
        if (d <= 0.0 || d < nearest) material = i;
        nearest = min(nearest, d);
    }
    imageStore(distance_image, pixel, vec4(nearest));
    imageStore(material_image, pixel, ivec4(material));
}
