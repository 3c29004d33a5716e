// Reads distance, material and the cascade above; writes, per probe and direction group, the mean of four directions,
// each traced to where the ray of each of the four nearest upper probes begins, and only then interpolated: the forked
// bilinear fix. A probe inside a shape gets 0 and 0. One thread is one probe and direction group.
// Rays begin on the group's own direction and end on each of its four (docs/methods/rc_fix.md), so that they join those
// of the cascades below and above without gap or overlap.
#version 430 core
#include "rc_fix.h"
#include "lib/march.glsl"

layout(local_size_x = kRcFixGroupX, local_size_y = kRcFixGroupY) in;
layout(std140, binding = kCascadeParamsBinding) uniform Params { RcFixParams params; };
layout(binding = kCascadeImageBinding) writeonly uniform image2D cascade_image;
layout(binding = kCascadeUpperUnit) uniform sampler2D upper_texture;
layout(binding = kSkySectorsUnit) uniform samplerBuffer sky_sectors;

vec3 sky_radiance(int direction) {
    return params.sky_first < 0 ? params.sky.rgb : texelFetch(sky_sectors, params.sky_first + direction).rgb;
}

vec2 child_direction(vec2 centre, int m) {
    float c = params.offset_cos[m];
    float s = params.offset_sin[m];
    return vec2(centre.x * c - centre.y * s, centre.y * c + centre.x * s);
}

ivec2 upper_corner(int direction) {
    return ivec2(direction % params.upper_tiles.x, direction / params.upper_tiles.x) * params.upper_probes;
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
    vec2 start = p + centre * params.start;

    // The four upper probes and their weights: those in free space only. A probe's alpha is the same in every group.
    vec2 index = clamp((p - params.upper_first) / params.upper_spacing, vec2(0.0), vec2(params.upper_probes) - 1.0);
    ivec2 lo = ivec2(index);
    ivec2 hi = min(lo + 1, params.upper_probes - 1);
    vec2 f = index - vec2(lo);
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    ivec4 xs = ivec4(lo.x, hi.x, lo.x, hi.x);
    ivec4 ys = ivec4(lo.y, lo.y, hi.y, hi.y);
    for (int j = 0; j < 4; ++j) weights[j] *= texelFetch(upper_texture, ivec2(xs[j], ys[j]), 0).a;
    float total = weights.x + weights.y + weights.z + weights.w;
    // Where none is free, the ray goes on alone until it meets something.
    bool alone = total <= 0.0;
    weights = alone ? vec4(1.0, 0.0, 0.0, 0.0) : weights / total;

    // Where nothing is within reach every ray passes, and to interpolate first is the same: one filtered fetch a direction.
    vec2 margin = min(start - params.domain.xy, params.domain.zw - start);
    bool open = !alone && min(margin.x, margin.y) > params.longest &&
                texelFetch(distance_texture, clamp(ivec2(floor(start)) + params.border, ivec2(0), textureSize(distance_texture, 0) - 1), 0).r > params.longest + kHalfDiagonal;
    if (kSceneMedia != 0) open = open && !may_cross_media(start - params.longest, vec2(2.0 * params.longest));
    vec3 sum = vec3(0.0);
    vec2 upper_probe = index + 0.5;
    for (int m = open ? 0 : 4; m < 4; ++m) {
        vec4 above = textureLod(upper_texture, (vec2(upper_corner(4 * group + m)) + upper_probe) * params.upper_texel, 0.0);
        sum += above.rgb / max(above.a, 1e-6);
    }

    int budget = kMarchBudget;
    for (int i = open ? 16 : 0; i < 16; ++i) {
        int j = i & 3;
        float weight = weights[j];
        if (weight > 0.0) {
            int direction = 4 * group + (i >> 2);
            vec2 d = child_direction(centre, i >> 2);
            vec2 q = params.upper_first + vec2(xs[j], ys[j]) * params.upper_spacing;
            vec2 way = q + d * params.end - start;
            float far = length(way);
            if (alone) far = kNeverLeaves;
            else d = way / far;
            vec3 radiance, through;
            int fate = march_through(start, d, 0.0, far, params.domain, params.border, budget, radiance, through);
            if (fate == kRayLeft) radiance += through * sky_radiance(direction);
            if (fate == kRayPassed) radiance += through * texelFetch(upper_texture, upper_corner(direction) + ivec2(xs[j], ys[j]), 0).rgb;
            sum += weight * radiance;
        }
    }
    if (kCountSteps != 0) sum = vec3(4.0 * float(kMarchBudget - budget));
    imageStore(cascade_image, texel, vec4(0.25 * sum, 1.0));
    report_lost_rays();
}
