// Reads how many points each tile asks for; writes the solver's jobs, four points of one tile each, and how many groups
// they fill. One thread is one tile.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(std430, binding = kExactPointsStorage) writeonly buffer Jobs { uint out_jobs[]; };
layout(std430, binding = kExactCountersStorage) buffer Counters { uint counters[]; };

void main() {
    int tile = int(gl_GlobalInvocationID.x);
    if (tile >= params.extent.x) return;
    uint fours = (counters[params.first_count + tile] + 3u) / 4u;
    if (fours == 0u) return;
    int level = kExactCountLevel + 4 * params.level;
    uint first = atomicAdd(counters[level], fours);
    // The group count: as often as a multiple of the group's size is passed.
    uint size = uint(kExactSolveGroupX);
    uint groups = (first + fours + size - 1u) / size - (first + size - 1u) / size;
    if (groups > 0u) atomicAdd(counters[level + 1], groups);
    for (uint i = 0u; i < fours; ++i) out_jobs[first + i] = uint(tile) | (i << 24);
}
