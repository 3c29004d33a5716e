// Reads the solved points; writes the mean radiance of every pixel: solved there, or interpolated between the corners of
// its cell. One thread is one pixel.
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
    ivec2 texel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= params.extent.x || texel.y >= params.extent.y) return;
    ivec2 at = texel + params.fill_first;
    int h = kExactCell;
    if (int(imageLoad(leaf_image, at / 8 * 8).r) < 8) h = 4;
    if (h == 4 && int(imageLoad(leaf_image, at / 4 * 4).r) < 4) h = 2;
    if (h == 2 && int(imageLoad(leaf_image, at / 2 * 2).r) < 2) h = 1;
    ivec2 corner = at / h * h;
    vec3 sum = vec3(0.0);
    if (h == 1) sum = imageLoad(value_image, corner).rgb;
    if (h > 1) {
        // At the canvas's edges the far corners were moved inwards.
        ivec2 last = params.canvas - 1 - ivec2(0, params.first_row);
        vec2 size = vec2(min(corner + h, last) - corner);
        vec2 u = vec2(at - corner) / max(size, vec2(1.0));
        for (int k = 0; k < 4; ++k) {
            ivec2 which = ivec2(k & 1, k >> 1);
            ivec2 from = corner + which * h;
            vec2 w = pick(1.0 - u, u, equal(which, ivec2(1)));
            vec2 away = vec2(at - corner) - vec2(which) * size;
            // Half of what the slopes foretell, weighted: exact for quadratics.
            vec3 value = imageLoad(value_image, from).rgb + 0.5 * (imageLoad(slope_x_image, from).rgb * away.x +
                         imageLoad(slope_y_image, from).rgb * away.y);
            sum += w.x * w.y * value;
        }
        if (kSigned == 0) sum = clamp(sum, vec3(0.0), params.most.rgb);
    }
    imageStore(radiance_image, texel + ivec2(0, params.fill_row), vec4(sum, 1.0));
}
