// Reads lists of what may stand between tiles and lights; adds to the mean radiance of each free pixel what its lights give:
// irradiance across the beam over the full circle. One thread is one pixel.
#version 430 core
#include "delta.h"

layout(local_size_x = kDeltaGroupX, local_size_y = kDeltaGroupY) in;
layout(std140, binding = kDeltaParamsBinding) uniform Params { DeltaParams params; };
layout(binding = kDeltaDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kDeltaHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kDeltaEntriesUnit) uniform samplerBuffer entries;
layout(binding = kDeltaLightsUnit) uniform samplerBuffer lights;
layout(binding = kDeltaRadianceImage, rgba32f) uniform image2D radiance_image;

#include "lib/delta.glsl"
#include "lib/media.glsl"

void main() {
    ivec2 at = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.extent.x || at.y >= params.extent.y) return;
    ivec2 pixel = at + params.list_origin;
    ivec2 place = at + ivec2(0, params.first_row);
    // Without shapes the distance is a single texel.
    float room = texelFetch(distance_texture, min(pixel + params.border, textureSize(distance_texture, 0) - 1), 0).r;
    ivec2 tile = at / kDeltaTile;
    int list = (tile.y * params.tiles.x + tile.x) * params.lights;
    vec2 p = vec2(pixel) + 0.5;
    vec3 sum = vec3(0.0);
    int end_light = room > 0.0 ? params.end_light : params.first_light;
    for (int light = params.first_light; light < end_light; ++light) {
        uvec4 head = texelFetch(heads, list + light);
        Arrival arrival = arrival_at(light, p, params.least_distance);
        bool dark = head.x == kDeltaDark || all(equal(arrival.strength, vec3(0.0)));
        if (dark || list_hides(head, p, arrival.way, arrival.end)) continue;
        vec3 through = vec3(1.0);
        if (kSceneMedia != 0) {
            float far = length(arrival.way);
            vec3 gained;
            int budget = kDeltaMediaBudget;
            // The box of all media ends the way to what has no distance.
            if (!cross_media(p, arrival.way / max(far, 1e-20), 0.0, arrival.end > 1.0 ? kFar : far, budget, gained, through)) through = vec3(0.0);
        }
        sum += through * arrival.strength;
    }
    vec4 radiance = params.adds != 0 ? imageLoad(radiance_image, place) : vec4(0.0, 0.0, 0.0, 1.0);
    imageStore(radiance_image, place, radiance + vec4(sum * 0.15915494309189535, 0.0));
}
