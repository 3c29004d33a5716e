// Reads the fluence of each lattice point; writes each pixel's mean radiance, interpolated between the lattice
// points in free space. One thread is one pixel.
#version 430 core
#include "hrc.h"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kHrcSumUnit) uniform sampler2D sum_texture;

const float kTurn = 6.28318530717958648;

vec4 weighted(ivec2 point, float weight) {
    vec4 sum = texelFetch(sum_texture, clamp(point, ivec2(0), params.points - 1), 0);
    return weight * sum.a * vec4(sum.rgb, 1.0);
}

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec2 at = (vec2(pixel) + 0.5 - params.first_point) / params.cell;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 sum = weighted(base, (1.0 - f.x) * (1.0 - f.y)) + weighted(base + ivec2(1, 0), f.x * (1.0 - f.y)) +
               weighted(base + ivec2(0, 1), (1.0 - f.x) * f.y) + weighted(base + ivec2(1, 1), f.x * f.y);
    imageStore(radiance_image, pixel, sum.a > 0.0 ? vec4(sum.rgb / (sum.a * kTurn), 1.0) : vec4(0.0));
}
