// Reads the solved points; writes the mean radiance of every pixel: solved there, or interpolated between the corners of
// its cell. One thread is one pixel.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactValueUnit) uniform sampler2D value_texture;
layout(binding = kExactSlopeXUnit) uniform sampler2D slope_x_texture;
layout(binding = kExactSlopeYUnit) uniform sampler2D slope_y_texture;
layout(binding = kExactLeafUnit) uniform usampler2D leaf_texture;
layout(binding = kExactValueImage) writeonly uniform image2D radiance_image;

void main() {
    ivec2 at = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.extent.x || at.y >= params.extent.y) return;
    int h = kExactTile;
    while (h > 1 && int(texelFetch(leaf_texture, at / h * h, 0).r) < h) h /= 2;
    ivec2 corner = at / h * h;
    ivec2 tile = at / kExactTile;
    ivec2 block = tile * kExactBlock + corner - tile * kExactTile;
    vec3 sum = vec3(0.0);
    if (h == 1) sum = texelFetch(value_texture, block, 0).rgb;
    if (h > 1) {
        // At the canvas's edges the far corners were moved inwards.
        ivec2 last = params.canvas - 1 - ivec2(0, params.first_row);
        vec2 size = vec2(min(corner + h, last) - corner);
        vec2 u = vec2(at - corner) / max(size, vec2(1.0));
        for (int k = 0; k < 4; ++k) {
            ivec2 which = ivec2(k & 1, k >> 1);
            ivec2 from = block + which * h;
            vec2 w = mix(1.0 - u, u, equal(which, ivec2(1)));
            vec2 away = vec2(at - corner) - vec2(which) * size;
            // Half of what the slopes foretell, weighted: exact for quadratics.
            vec3 value = texelFetch(value_texture, from, 0).rgb + 0.5 * (texelFetch(slope_x_texture, from, 0).rgb * away.x +
                         texelFetch(slope_y_texture, from, 0).rgb * away.y);
            sum += w.x * w.y * value;
        }
        sum = max(sum, vec3(0.0));
    }
    imageStore(radiance_image, at + ivec2(0, params.first_row), vec4(sum, 1.0));
}
