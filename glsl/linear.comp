// Reads mean radiance, distance and material; writes the linear picture at pixel centres, never
// antialiased; alpha is 1 in free pixels and 0 in solid ones. One thread is one pixel.
#version 430 core
#include "compose.h"
layout(std140, binding = kComposeParamsBinding) uniform Params { ComposeParams params; };
#include "lib/pixel.glsl"

layout(local_size_x = kComposeGroupX, local_size_y = kComposeGroupY) in;
layout(rgba32f, binding = kComposeImageBinding) writeonly uniform image2D linear_image;

void main() {
    ivec2 texel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(linear_image);
    // No return for threads beside the picture, since Mesa 22 would mask all that follows: what they store is dropped.
    ivec2 pixel = min(texel, size - 1) + params.first_pixel;
    bool solid = params.has_shapes != 0 && pixel_distance(pixel) <= 0.0;
    // Without a branch, whose both sides would run with lanes masked.
    vec3 radiance = pick(floor_radiance(pixel), solid_radiance(pixel, solid), bvec3(solid));
    // A scene may hold negative zeros, the picture none.
    imageStore(linear_image, texel, vec4(pick(radiance, vec3(0.0), equal(radiance, vec3(0.0))), solid ? 0.0 : 1.0));
}
