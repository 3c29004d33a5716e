// Reads the radiance of pixels, the distance and the material; gathers, by rays of their own, the light of free pixels that no probe
// about them could tell theirs: in a corner between shapes that is narrower than the lattice. One thread is one pixel.
#version 430 core
#include "cascade.h"
#include "lone.h"
#include "lib/march.glsl"

layout(local_size_x = kLoneGroupX, local_size_y = kLoneGroupY) in;
layout(std140, binding = kLoneParamsBinding) uniform Params { LoneParams params; };
layout(binding = kLoneImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kLoneRadianceUnit) uniform sampler2D radiance_texture;

void main() {
    ivec2 texel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= params.extent.x || texel.y >= params.extent.y) return;
    if (texelFetch(radiance_texture, texel, 0).a > 0.0) return;
    ivec2 pixel = texel + params.first_pixel;
    float room = texelFetch(distance_texture, clamp(pixel + params.border, ivec2(0), textureSize(distance_texture, 0) - 1), 0).r;
    if (room <= 0.0) return;
    vec2 p = vec2(pixel) + 0.5;
    vec3 sum = vec3(0.0);
    int budget = kMarchBudget;
    for (int ray = 0; ray < kLoneRays; ++ray) {
        float angle = (float(ray) + 0.5) * (6.28318530717958648 / float(kLoneRays));
        vec2 d = vec2(cos(angle), sin(angle));
        vec3 radiance, through;
        march_through(p, d, 0.0, kNeverLeaves, params.domain, params.border, budget, radiance, through);
        sum += radiance + through * params.sky.rgb;
    }
    imageStore(radiance_image, texel, vec4(sum / float(kLoneRays), 1.0));
    report_lost_rays();
}
