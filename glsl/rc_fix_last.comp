// Reads distance and material; writes the last cascade of `rc_fix`: per probe and direction group, the mean of four beams
// that go on to the sky, each as wide as its sector. A probe inside a shape gets 0 and 0. One thread is one probe and
// direction group.
#version 430 core
#include "rc_fix.h"
#include "lib/cone.glsl"

layout(local_size_x = kRcFixGroupX, local_size_y = kRcFixGroupY) in;
layout(std140, binding = kCascadeParamsBinding) uniform Params { RcFixParams params; };
layout(binding = kCascadeImageBinding) writeonly uniform image2D cascade_image;
layout(binding = kSkySectorsUnit) uniform samplerBuffer sky_sectors;

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
    float sector = 0.25 * params.group_angle;
    int budget = kMarchBudget;
    vec3 sum = vec3(0.0);
    for (int m = 0; m < 4; ++m) {
        float c = params.offset_cos[m];
        float s = params.offset_sin[m];
        vec2 d = vec2(centre.x * c - centre.y * s, centre.y * c + centre.x * s);
        vec3 radiance, passes;
        march_cone(p + centre * params.start, d, max(sector * params.start, 0.05), sector, params.domain, params.border, budget, radiance, passes);
        vec3 sky = params.sky_first < 0 ? params.sky.rgb : texelFetch(sky_sectors, params.sky_first + 4 * group + m).rgb;
        sum += radiance + passes * sky;
    }
    if (kCountSteps != 0) sum = vec3(4.0 * float(kMarchBudget - budget));
    imageStore(cascade_image, texel, vec4(0.25 * sum, 1.0));
    report_lost_rays();
}
