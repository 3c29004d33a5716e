// Reads the mean radiance that was sampled and that which was solved, of other lamps; writes their sum, since light adds up.
// What was solved may be a part of the canvas. One thread is one pixel.
#version 430 core
#include "sum.h"

layout(local_size_x = kSumGroupX, local_size_y = kSumGroupY) in;
layout(std140, binding = kSumParamsBinding) uniform Params { SumParams params; };
layout(binding = kSumImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kSumSampledUnit) uniform sampler2D sampled_texture;
layout(binding = kSumSolvedUnit) uniform sampler2D solved_texture;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    // Beyond the part that was solved nothing is shown.
    ivec2 of_part = clamp(pixel - params.first_lit, ivec2(0), textureSize(solved_texture, 0) - 1);
    vec4 sampled = texelFetch(sampled_texture, pixel, 0);
    imageStore(radiance_image, pixel, vec4(sampled.rgb + texelFetch(solved_texture, of_part, 0).rgb, sampled.a));
}
