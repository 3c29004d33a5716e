// Reads the nearest seed; lowers the distance to it. One thread is one grid pixel.
// A seed is a pixel that is solid at its centre; its edge is half a pixel nearer.
#version 430 core
#include "jump.h"

layout(local_size_x = kJumpGroupX, local_size_y = kJumpGroupY) in;
layout(std140, binding = kJumpParamsBinding) uniform Params { JumpParams params; };
layout(r32f, binding = kJumpDistanceBinding) uniform image2D distance_image;
layout(binding = kJumpSeedsUnit) uniform isampler2D seeds_in;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    ivec2 seed = texelFetch(seeds_in, pixel, 0).rg;
    if (seed.x == kNoSeed) return;
    float to_edge = length(vec2(seed - pixel)) - 0.5;
    float nearest = imageLoad(distance_image, pixel).r;
    if (to_edge < nearest) imageStore(distance_image, pixel, vec4(to_edge));
}
