// Reads cascade 0; writes the mean radiance of every pixel: the mean over direction groups, interpolated
// between probes in free space. One thread is one pixel. Not run when cascade 0 already is that.
#version 430 core
#include "resolve.h"

layout(local_size_x = kResolveGroupX, local_size_y = kResolveGroupY) in;
layout(std140, binding = kResolveParamsBinding) uniform Params { ResolveParams params; };
layout(binding = kResolveImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kResolveCascadeUnit) uniform sampler2D cascade_texture;

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec2 probe = (vec2(params.first_pixel + pixel) + 0.5 - params.first_probe) / params.spacing + 0.5;
    probe = clamp(probe, vec2(0.5), vec2(params.probes) - 0.5);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < params.tiles.y; ++y)
        for (int x = 0; x < params.tiles.x; ++x)
            sum += params.aligned != 0
                ? texelFetch(cascade_texture, ivec2(x, y) * params.probes + pixel, 0)
                : textureLod(cascade_texture, (vec2(ivec2(x, y) * params.probes) + probe) * params.texel, 0.0);
    imageStore(radiance_image, pixel, sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0));
}
