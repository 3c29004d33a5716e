// Reads distance, material and the cascade above; writes, per probe and direction group, the mean of four
// merged intervals: radiance, and 1; or 0 and 0 for a probe inside a shape, which sees nothing that its neighbours
// should. One thread is one probe and direction group.
// The layout is direction first: one tile of probes per group, so that the merge between the four nearest
// probes of the cascade above is one filtered fetch (docs/methods/rc.md).
#version 430 core
#include "cascade.h"
#include "lib/march.glsl"

layout(local_size_x = kCascadeGroupX, local_size_y = kCascadeGroupY) in;
layout(std140, binding = kCascadeParamsBinding) uniform Params { CascadeParams params; };
layout(binding = kCascadeImageBinding) writeonly uniform image2D cascade_image;
layout(binding = kCascadeUpperUnit) uniform sampler2D upper_texture;
layout(binding = kSkySectorsUnit) uniform samplerBuffer sky_sectors;

vec3 sky_radiance(int direction) {
    return params.sky_first < 0 ? params.sky.rgb : texelFetch(sky_sectors, params.sky_first + direction).rgb;
}

void main() {
    ivec2 texel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= params.extent.x || texel.y >= params.extent.y) return;
    ivec2 tile = texel / params.probes;
    ivec2 probe = texel - tile * params.probes;
    int group = tile.y * params.tiles.x + tile.x;
    vec2 p = params.first_probe + vec2(probe) * params.spacing;

    if (starts_inside(p, params.border)) {
        imageStore(cascade_image, texel, vec4(0.0));
        return;
    }

    float angle = (float(group) + 0.5) * params.group_angle;
    vec2 centre = vec2(cos(angle), sin(angle));
    vec2 upper_probe = (p - params.upper_first) / params.upper_spacing + 0.5;
    upper_probe = clamp(upper_probe, vec2(0.5), vec2(params.upper_probes) - 0.5);

    vec3 sum = vec3(0.0);
    int budget = kMarchBudget;
    for (int m = 0; m < 4; ++m) {
        float c = params.offset_cos[m];
        float s = params.offset_sin[m];
        vec2 d = vec2(centre.x * c - centre.y * s, centre.y * c + centre.x * s);
        int direction = 4 * group + m;
        vec3 radiance, through;
        vec4 above = vec4(0.0);
        if (params.is_last == 0) {
            // The mean over those of the four probes that are in free space.
            ivec2 upper_tile = ivec2(direction % params.upper_tiles.x, direction / params.upper_tiles.x);
            above = textureLod(upper_texture, (vec2(upper_tile * params.upper_probes) + upper_probe) * params.upper_texel, 0.0);
        }
        // Where none is, and after the last cascade, the ray goes on alone until it meets something.
        float end = above.a > 0.0 ? params.end : kNeverLeaves;
        int fate = march_through(p, d, params.start, end, params.domain, params.border, budget, radiance, through);
        if (fate == kRayLeft) radiance += through * sky_radiance(direction);
        if (fate == kRayPassed) radiance += through * (above.rgb / above.a);
        sum += radiance;
    }
    if (kCountSteps != 0) sum = vec3(4.0 * float(kMarchBudget - budget));
    imageStore(cascade_image, texel, vec4(0.25 * sum, 1.0));
    report_lost_rays();
}
