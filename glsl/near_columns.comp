// Reads where a bitmap shows; writes how far the nearest such pixel of the same column is. One thread is one pixel of a tile near a bitmap.
// Images read as 0 outside: nothing shows there.
#version 430 core
#include "jump.h"

layout(local_size_x = kJumpGroupX, local_size_y = kJumpGroupY) in;
layout(std140, binding = kJumpParamsBinding) uniform Params { JumpParams params; };
layout(r8ui, binding = kNearSeedsImage) readonly uniform uimage2D seeds_image;
layout(r8ui, binding = kNearColumnsImage) writeonly uniform uimage2D columns_image;
layout(binding = kNearTilesUnit) uniform isamplerBuffer tiles;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.y >= params.step) return;
    ivec2 pixel = texelFetch(tiles, id.y).rg + ivec2(id.x % kNearTile, id.x / kNearTile);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    uint nearness = 0u;
    for (int y = -kNearSeeds; y <= kNearSeeds; ++y)
        nearness = max(nearness, imageLoad(seeds_image, pixel + ivec2(0, y)).r * uint(kNearSeeds + 1 - abs(y)));
    imageStore(columns_image, pixel, uvec4(nearness));
}
