// Reads mean radiance, distance and material; writes the picture for display: coverage at edges, exposure,
// tone curve, sRGB. One thread is one pixel.
#version 430 core
#include "compose.h"
layout(std140, binding = kComposeParamsBinding) uniform Params { ComposeParams params; };
#include "lib/pixel.glsl"
#include "lib/tonemap.glsl"

// Which program this is: whether edges are mixed (2), solids show (1) or there are none (0). Its curve is kComposeTonemap.
const int kEdges = 2;

layout(local_size_x = kComposeGroupX, local_size_y = kComposeGroupY) in;
layout(binding = kComposeImageBinding) writeonly uniform image2D picture_image;

// The floor beside a solid edge pixel: the mean of its free neighbours. The pixel's own probe sits inside
// the shape, and would leak its light or its dark into the edge. A loop that its caller may have no turn of: nine
// copies of what it does would run for every pixel, since Mesa runs both sides of a branch, but a loop only once.
vec4 floor_beside(ivec2 pixel, bool asked) {
    vec4 sum = vec4(0.0);
    for (int i = asked ? 0 : 9; i < 9; ++i) {
        int row = (i * 11) >> 5;  // i / 3
        ivec2 at = clamp(pixel + ivec2(i - 3 * row, row) - 1, ivec2(0), params.extent - 1);
        if (pixel_distance(at) > 0.0) sum += vec4(floor_radiance(at), 1.0);
    }
    return sum;
}

vec3 pixel_radiance(ivec2 pixel) {
    if (kEdges == 0 || params.has_shapes == 0) return floor_radiance(pixel);
    float d = pixel_distance(pixel);
    bool solid = d <= 0.0;
    if (kEdges == 1) return pick(floor_radiance(pixel), solid_radiance(pixel, solid), bvec3(solid));
    float coverage = params.antialias != 0 ? clamp(0.5 - d, 0.0, 1.0) : (solid ? 1.0 : 0.0);
    vec3 shape = solid_radiance(pixel, coverage > 0.0);
    vec4 beside = floor_beside(pixel, solid && coverage < 1.0);
    vec3 free = floor_radiance(pixel);
    if (solid) free = beside.a > 0.0 ? beside.rgb / beside.a : shape;
    return coverage >= 1.0 ? shape : coverage <= 0.0 ? free : mix(free, shape, coverage);
}

// Rounds to codes with triangular noise that depends on the pixel only (pcg3d: Jarzynski and Olano, JCGT 2020); within half a code of
// black and white with noise one code wide, which is never cut off. core/film/encode.h says why.
vec3 dithered(vec3 value, ivec2 pixel, float levels) {
    uvec3 v = uvec3(pixel, 0) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    vec3 first = vec3(v >> 16u) / 65536.0;
    vec3 second = vec3(v & 0xffffu) / 65536.0;
    vec3 scaled = value * levels;
    vec3 inside = vec3(greaterThanEqual(scaled, vec3(0.5))) * vec3(lessThanEqual(scaled, vec3(levels - 0.5)));
    return clamp(floor(scaled + first + inside * (0.5 - second)), 0.0, levels) / levels;
}

void main() {
    ivec2 texel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(picture_image);
    // No return for threads beside the picture, since Mesa 22 would mask all that follows: what they store is dropped.
    ivec2 pixel = min(texel, size - 1) + params.first_pixel;
    vec3 radiance = max(pixel_radiance(pixel) * params.exposure, vec3(0.0));
    vec3 encoded = srgb_encode(clamp(tonemap(radiance, params.white), 0.0, 1.0));
    if (kComposeDither != 0) encoded = dithered(encoded, pixel, float(params.levels));
    imageStore(picture_image, texel, vec4(encoded, 1.0));
}
