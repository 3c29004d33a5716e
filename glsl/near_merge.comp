// Reads how far a bitmap's pixels are along each column of the window; lowers the distance to the nearest. One thread is one pixel of a
// tile near a bitmap. Such a pixel is solid at its centre; its edge is half a pixel nearer.
#version 430 core
#include "jump.h"

layout(local_size_x = kJumpGroupX, local_size_y = kJumpGroupY) in;
layout(std140, binding = kJumpParamsBinding) uniform Params { JumpParams params; };
layout(r8ui, binding = kNearColumnsImage) readonly uniform uimage2D columns_image;
layout(r32f, binding = kJumpDistanceBinding) uniform image2D distance_image;
layout(binding = kNearTilesUnit) uniform isamplerBuffer tiles;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.y >= params.step) return;
    ivec2 pixel = texelFetch(tiles, id.y).rg + ivec2(id.x % kNearTile, id.x / kNearTile);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    const int none = 4 * kNearSeeds * kNearSeeds;
    int squared = none;
    for (int x = -kNearSeeds; x <= kNearSeeds; ++x) {
        int nearness = int(imageLoad(columns_image, pixel + ivec2(x, 0)).r);
        int y = kNearSeeds + 1 - nearness;
        squared = min(squared, nearness == 0 ? none : x * x + y * y);
    }
    if (squared == none) return;
    float to_edge = sqrt(float(squared)) - 0.5;
    float nearest = imageLoad(distance_image, pixel).r;
    if (to_edge < nearest) imageStore(distance_image, pixel, vec4(to_edge));
}
