// Reads the packed scene and the distance (solid pixels are left out); adds this dispatch's rays to the sum of
// what each pixel sees. One thread is one pixel. Brute force: each ray against each shape, exactly.
#version 430 core
#include "reference.h"
#include "lib/domain.glsl"
#include "lib/intersect.glsl"
#include "lib/surface_light.glsl"
#include "lib/media.glsl"

layout(local_size_x = kReferenceGroupX, local_size_y = kReferenceGroupY) in;
layout(std140, binding = kReferenceParamsBinding) uniform Params { ReferenceParams params; };
layout(rgba32f, binding = kReferenceImageBinding) uniform image2D sum_image;
layout(binding = kReferenceDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kSkySectorsUnit) uniform samplerBuffer sky_sectors;

// Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020: pcg.
uint hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

vec3 ray_radiance(vec2 p, int ray, uint seed) {
    float jitter = float(hash(seed + uint(ray)) >> 8) * (1.0 / 16777216.0);
    float angle = (float(ray) + jitter) * (6.28318530717958648 / float(params.ray_count));
    vec2 d = vec2(cos(angle), sin(angle));
    float t;
    int hit = first_hit(p, d, params.shape_count, t);
    float leaves = exit_distance(p, d, params.domain);
    int budget = kReferenceBudget;
    vec3 light;
    if (hit >= 0 && t <= leaves) {
        // A bitmap's colour is asked just inside the texel that was met.
        light = shape_emission(hit, p + d * (t + 1e-3));
        if (kSceneSurfaces != 0) light = surface_light(p + d * t, d, params.border, light, budget);
    } else {
        light = params.sky_first < 0 ? params.sky.rgb : texelFetch(sky_sectors, params.sky_first + ray).rgb;
    }
    if (kSceneMedia != 0) {
        vec3 gained, through;
        bool arrived = cross_media(p, d, 0.0, min(t, leaves), budget, gained, through);
        light = gained + (arrived ? through : vec3(0.0)) * light;
    }
    return light;
}

void main() {
    ivec2 texel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= params.extent.x || texel.y >= params.extent.y) return;
    ivec2 pixel = texel + params.first_pixel;
    vec4 sum = params.first_ray == 0 ? vec4(0.0) : imageLoad(sum_image, texel);
    ivec2 at = min(pixel + params.border, textureSize(distance_texture, 0) - 1);
    if (texelFetch(distance_texture, at, 0).r > 0.0) {
        vec2 p = vec2(pixel) + 0.5;
        uint seed = hash(uint(pixel.x) + hash(uint(pixel.y)));
        for (int ray = params.first_ray; ray < params.end_ray; ++ray) sum.rgb += ray_radiance(p, ray, seed);
    }
    if (params.is_last != 0) sum /= float(params.ray_count);
    imageStore(sum_image, texel, sum);
}
