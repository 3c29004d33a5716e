// Reads one corner of each tile; writes the mean of their light, which tolerances are relative to. One thread sums one
// column of tiles; a second run with one thread sums those.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactValueUnit) uniform sampler2D value_texture;
layout(binding = kExactSkyUnit) uniform samplerBuffer columns;
layout(std430, binding = kExactPointsStorage) writeonly buffer Means { float out_means[]; };

void main() {
    int x = int(gl_GlobalInvocationID.x);
    if (x >= params.extent.x) return;
    float sum = 0.0;
    if (params.level == 0) {
        for (int y = 0; y < params.tiles.y; ++y) {
            vec3 c = texelFetch(value_texture, ivec2(x, y) * kExactTile, 0).rgb;
            sum += max(c.r, max(c.g, c.b));
        }
        out_means[1 + x] = sum / float(params.tiles.y);
    } else {
        for (int i = 0; i < params.tiles.x; ++i) sum += texelFetch(columns, 1 + i).r;
        out_means[0] = sum / float(params.tiles.x);
    }
}
