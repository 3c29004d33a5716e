// Reads lists of what may stand between tiles and lights; writes the irradiance that surfaces have of the lights, by element.
// One thread is one element.
#version 430 core
#include "delta.h"

layout(local_size_x = kDeltaGroupX, local_size_y = kDeltaGroupY) in;
layout(std140, binding = kDeltaParamsBinding) uniform Params { DeltaParams params; };
layout(binding = kDeltaJobsUnit) uniform usamplerBuffer jobs;
layout(binding = kDeltaNodesUnit) uniform samplerBuffer nodes;
layout(binding = kDeltaHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kDeltaEntriesUnit) uniform samplerBuffer entries;
layout(binding = kDeltaLightsUnit) uniform samplerBuffer lights;
layout(binding = kDeltaRadianceImage, rgba32f) uniform image2D radiance_image;

#include "lib/delta.glsl"

void main() {
    int node = int(gl_GlobalInvocationID.x) + params.origin.y * params.extent.x;
    if (node >= 4 * params.jobs) return;
    int list = int(texelFetch(jobs, node / 4).r) * params.lights;
    vec4 place = texelFetch(nodes, 2 * node);
    vec4 extent = texelFetch(nodes, 2 * node + 1);
    int element = int(extent.x);
    vec3 sum = vec3(0.0);
    for (int light = params.first_light; light < params.end_light; ++light) {
        uvec4 head = texelFetch(heads, list + light);
        for (int k = 0; k < kDeltaSamples; ++k) {
            vec2 p = place.xy + extent.yz * ((float(k) + 0.5) / float(kDeltaSamples) - 0.5);
            Arrival arrival = arrival_at(light, p, params.least_distance);
            float cosine = dot(place.zw, arrival.way) / max(length(arrival.way), 1e-30);
            bool dark = head.x == kDeltaDark || cosine <= 0.0 || all(equal(arrival.strength, vec3(0.0)));
            if (!dark && !list_hides(head, p, arrival.way, arrival.end)) sum += arrival.strength * cosine / float(kDeltaSamples);
        }
    }
    ivec2 at = ivec2(element % kDeltaNodeRow, element / kDeltaNodeRow);
    if (params.adds != 0) sum += imageLoad(radiance_image, at).rgb;
    imageStore(radiance_image, at, vec4(sum, 1.0));
}
