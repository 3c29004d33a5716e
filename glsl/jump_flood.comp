// Reads the seeds at nine places a jump apart; writes the nearest. One thread is one grid pixel.
// Rong and Tan, "Jump flooding in GPU with applications to Voronoi diagram and distance transform", 2006.
#version 430 core
#include "jump.h"

layout(local_size_x = kJumpGroupX, local_size_y = kJumpGroupY) in;
layout(std140, binding = kJumpParamsBinding) uniform Params { JumpParams params; };
layout(rg16i, binding = kJumpImageBinding) writeonly uniform iimage2D seeds_out;
layout(binding = kJumpSeedsUnit) uniform isampler2D seeds_in;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    ivec2 best = ivec2(kNoSeed);
    float best_squared = 1e30;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = pixel + params.step * ivec2(x, y);
            if (at.x < 0 || at.y < 0 || at.x >= params.extent.x || at.y >= params.extent.y) continue;
            ivec2 seed = texelFetch(seeds_in, at, 0).rg;
            if (seed.x == kNoSeed) continue;
            vec2 to = vec2(seed - pixel);
            float squared = dot(to, to);
            if (squared < best_squared) { best_squared = squared; best = seed; }
        }
    }
    imageStore(seeds_out, pixel, ivec4(best, 0, 0));
}
