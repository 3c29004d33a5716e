// Writes pixels that outlines close off from all light: solid, and of no shape. A row of threads is a tile.
#version 430 core
#include "closed.h"

layout(local_size_x = kClosedGroupX, local_size_y = kClosedGroupY) in;
layout(std140, binding = kClosedParamsBinding) uniform Params { ClosedParams params; };
layout(binding = kClosedDistanceImage, r32f) writeonly uniform image2D distance_image;
layout(binding = kClosedMaterialImage, r32i) writeonly uniform iimage2D material_image;
layout(binding = kClosedTilesUnit) uniform usamplerBuffer tiles;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    ivec2 pixel = ivec2(texelFetch(tiles, id.y).rg) + ivec2(id.x % params.tile, id.x / params.tile);
    if (pixel.x >= params.canvas.x || pixel.y >= params.canvas.y) return;
    imageStore(distance_image, pixel + params.border, vec4(kClosedDistance));
    imageStore(material_image, pixel + params.border, ivec4(-1));
}
