// Reads which points each tile asks for; writes them as a list, row by row, the solver's jobs, four points of one tile each,
// and how many groups they fill. One thread is one tile.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactAsksUnit) uniform usamplerBuffer asks;
layout(std430, binding = kExactPointsStorage) writeonly buffer Points { uint out_points[]; };
layout(std430, binding = kExactJobsStorage) writeonly buffer Jobs { uint out_jobs[]; };
layout(std430, binding = kExactCountersStorage) buffer Counters { uint counters[]; };

void main() {
    int tile = int(gl_GlobalInvocationID.x);
    if (tile >= params.extent.x) return;
    int from = params.first_point + tile * params.tile_points;
    int to = from;
    for (int row = 0; row < kExactTileRows; ++row) {
        uint left = texelFetch(asks, params.first_ask + tile * kExactTileRows + row).r;
        while (left != 0u) {
            out_points[to] = uint(findLSB(left) | (row << 8));
            ++to;
            left &= left - 1u;
        }
    }
    counters[params.first_count + tile] = uint(to - from);
    uint fours = uint(to - from + 3) / 4u;
    if (fours == 0u) return;
    int level = kExactCountLevel + 4 * params.level;
    uint first = atomicAdd(counters[level], fours);
    // The group count: as often as a multiple of the group's size is passed.
    uint size = uint(kExactSolveGroupX);
    uint groups = (first + fours + size - 1u) / size - (first + size - 1u) / size;
    if (groups > 0u) atomicAdd(counters[level + 1], groups);
    for (uint i = 0u; i < fours; ++i) out_jobs[first + i] = uint(tile) | (i << 24);
}
