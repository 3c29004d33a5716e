// Reads distance and material; writes where a bitmap shows. One thread is one pixel of a tile near a bitmap.
// A bitmap hidden under another shape needs no mark: that shape's outline is nearer.
#version 430 core
#include "jump.h"
#include "lib/scene.glsl"

layout(local_size_x = kJumpGroupX, local_size_y = kJumpGroupY) in;
layout(std140, binding = kJumpParamsBinding) uniform Params { JumpParams params; };
layout(r8ui, binding = kNearSeedsImage) writeonly uniform uimage2D seeds_image;
layout(r32f, binding = kJumpDistanceBinding) readonly uniform image2D distance_image;
layout(binding = kJumpMaterialUnit) uniform isampler2D material_texture;
layout(binding = kNearTilesUnit) uniform isamplerBuffer tiles;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.y >= params.step) return;
    ivec2 pixel = texelFetch(tiles, id.y).rg + ivec2(id.x % kNearTile, id.x / kNearTile);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    int material = texelFetch(material_texture, pixel, 0).r;
    bool seed = material >= 0 && imageLoad(distance_image, pixel).r <= 0.0 &&
                int(texelFetch(shape_records, material * kShapeTexels).x) == kShapeBitmap;
    imageStore(seeds_image, pixel, uvec4(seed ? 1u : 0u));
}
