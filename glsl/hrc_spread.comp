// Reads the fluence of each lattice point, distance and material; writes each pixel's mean radiance, interpolated between the
// lattice points that its centre sees. One thread is one pixel.
#version 430 core
#include "cascade.h"
#include "hrc.h"
#include "lib/march.glsl"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kHrcSumUnit) uniform sampler2D sum_texture;

const float kTurn = 6.28318530717958648;

vec4 weighted(ivec2 point, float weight) {
    vec4 sum = texelFetch(sum_texture, clamp(point, ivec2(0), params.points - 1), 0);
    return weight * sum.a * vec4(sum.rgb, 1.0);
}

// Whether nothing stands between the pixel's centre and a lattice point.
bool sees(vec2 p, ivec2 point, inout int budget) {
    vec2 way = params.first_point + params.cell * vec2(clamp(point, ivec2(0), params.points - 1)) - p;
    float far = length(way);
    vec3 radiance;
    return far < 1e-3 || march(p, way / far, 0.0, far, params.domain, params.border, budget, radiance) != kRayBlocked;
}

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec2 p = vec2(pixel) + 0.5;
    vec2 at = (p - params.first_point) / params.cell;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    float room = texelFetch(distance_texture, clamp(pixel + params.border, ivec2(0), textureSize(distance_texture, 0) - 1), 0).r;
    // Farther from all shapes than from the four lattice points it sees them all.
    bool open = room <= 0.0 || room > 1.4143 * params.cell;
    int budget = kMarchBudget;
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    for (int k = open ? 4 : 0; k < 4; ++k)
        if (weights[k] > 0.0 && !sees(p, base + ivec2(k & 1, k >> 1), budget)) weights[k] = 0.0;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; ++k) sum += weighted(base + ivec2(k & 1, k >> 1), weights[k]);
    // Where it sees none, those around them.
    for (int k = open || sum.a > 0.0 ? 16 : 0; k < 16; ++k) {
        ivec2 step = ivec2(k & 3, k >> 2) - 1;
        vec2 away = vec2(step) - f;
        bool inner = step == clamp(step, ivec2(0), ivec2(1));
        if (!inner && sees(p, base + step, budget)) sum += weighted(base + step, 1.0 / dot(away, away));
    }
    imageStore(radiance_image, pixel, sum.a > 0.0 ? vec4(sum.rgb / (sum.a * kTurn), 1.0) : vec4(0.0));
}
