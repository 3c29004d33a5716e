// Reads the solved points; writes the mean radiance of every pixel: solved there, or interpolated between the corners of
// its cell. One thread is a block of two by two pixels, which lie within one cell.
#version 430 core
#include "exact.h"
#include "lib/pick.glsl"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactValueImage, rgba32f) readonly uniform image2D value_image;
layout(binding = kExactSlopeXImage, rgba32f) readonly uniform image2D slope_x_image;
layout(binding = kExactSlopeYImage, rgba32f) readonly uniform image2D slope_y_image;
layout(binding = kExactLeafImage, r32ui) readonly uniform uimage2D leaf_image;
layout(binding = kExactRadianceImage) writeonly uniform image2D radiance_image;

// Which program this is: whether values may be negative.
const int kSigned = 0;

void main() {
    ivec2 block = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (block.x >= params.extent.x || block.y >= params.extent.y) return;
    ivec2 first = params.fill_first / 2 * 2 + 2 * block;  // of the band
    int h = kExactCell;
    if (int(imageLoad(leaf_image, first / 8 * 8).r) < 8) h = 4;
    if (h == 4 && int(imageLoad(leaf_image, first / 4 * 4).r) < 4) h = 2;
    // Four pixels are solved, or lie between the four corners of one cell.
    bool solved = h == 2 && int(imageLoad(leaf_image, first).r) < 2;
    ivec2 corner = first / h * h;
    int reach = solved ? 1 : h;
    vec3 values[4], slopes_x[4], slopes_y[4];
    for (int k = 0; k < 4; ++k) {
        ivec2 from = corner + reach * ivec2(k & 1, k >> 1);
        values[k] = imageLoad(value_image, from).rgb;
        slopes_x[k] = imageLoad(slope_x_image, from).rgb;
        slopes_y[k] = imageLoad(slope_y_image, from).rgb;
    }
    // At the canvas's edges the far corners were moved inwards.
    ivec2 last = params.canvas - 1 - ivec2(0, params.first_row);
    vec2 size = vec2(min(corner + h, last) - corner);
    for (int pixel = 0; pixel < 4; ++pixel) {
        ivec2 at = first + ivec2(pixel & 1, pixel >> 1);
        vec2 off = vec2(at - corner);
        vec2 u = off / max(size, vec2(1.0));
        vec3 sum = vec3(0.0);
        for (int k = 0; k < 4; ++k) {
            ivec2 which = ivec2(k & 1, k >> 1);
            vec2 w = pick(1.0 - u, u, equal(which, ivec2(1)));
            vec2 away = off - vec2(which) * size;
            // Half of what the slopes foretell, weighted: exact for quadratics.
            sum += w.x * w.y * (values[k] + 0.5 * (slopes_x[k] * away.x + slopes_y[k] * away.y));
        }
        if (kSigned == 0) sum = clamp(sum, vec3(0.0), params.most.rgb);
        sum = solved ? values[pixel] : sum;
        ivec2 texel = at - params.fill_first;
        if (texel.x >= 0 && texel.y >= 0 && texel.x < params.fill_size.x && texel.y < params.fill_size.y)
            imageStore(radiance_image, texel + ivec2(0, params.fill_row), vec4(sum, 1.0));
    }
}
