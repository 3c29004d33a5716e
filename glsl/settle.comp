// Reads one texel through every texture unit, so that each has a sampler of the plainest kind; writes their sum.
// One thread is one texel of the output.
#version 430 core
#include "settle.h"

layout(local_size_x = kSettleGroupX) in;
layout(std140, binding = kSettleParamsBinding) uniform Params { SettleParams params; };
layout(binding = kSettleImageBinding) writeonly uniform image2D sum_image;
layout(binding = 0) uniform sampler2D textures[kSettleUnits];

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < kSettleUnits; ++i) sum += texelFetch(textures[i], ivec2(0), 0);
    imageStore(sum_image, pixel, sum);
}
