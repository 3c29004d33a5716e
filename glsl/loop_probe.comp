// Writes how many iterations a loop made of those it was asked for: Mesa before 25 ends the loops of an
// invocation after 65535 without a word. One thread counts; eight fill a vector.
#version 430 core
#include "loop_probe.h"

layout(local_size_x = 8, local_size_y = 1) in;
layout(std140, binding = kLoopProbeParamsBinding) uniform Params { LoopProbeParams params; };
layout(r32i, binding = kLoopProbeImageBinding) writeonly uniform iimage2D count_image;

void main() {
    int count = 0;
    uint state = uint(params.origin.x) + gl_GlobalInvocationID.x;
    for (int i = 0; i < params.iterations; ++i) {
        // A chain that no compiler sums up.
        state = state * 747796405u + 2891336453u;
        count += (state ^ (state >> 16u)) == 1u ? 0 : 1;
    }
    imageStore(count_image, ivec2(gl_GlobalInvocationID.xy), ivec4(count));
}
