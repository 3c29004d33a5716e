// Reads the material; writes each bitmap pixel as its own seed, all others as none. One thread is one
// grid pixel. A bitmap hidden under another shape needs no seed: that shape's outline is nearer.
#version 430 core
#include "jump.h"
#include "lib/scene.glsl"

layout(local_size_x = kJumpGroupX, local_size_y = kJumpGroupY) in;
layout(std140, binding = kJumpParamsBinding) uniform Params { JumpParams params; };
layout(rg16i, binding = kJumpImageBinding) writeonly uniform iimage2D seeds_out;
layout(r32f, binding = kJumpDistanceBinding) readonly uniform image2D distance_image;
layout(binding = kJumpMaterialUnit) uniform isampler2D material_texture;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    int material = texelFetch(material_texture, pixel, 0).r;
    bool seed = material >= 0 && imageLoad(distance_image, pixel).r <= 0.0 &&
                int(texelFetch(shape_records, material * kShapeTexels).x) == kShapeBitmap;
    imageStore(seeds_out, pixel, ivec4(seed ? pixel : ivec2(kNoSeed), 0, 0));
}
