// Reads lists of what may stand between tiles and lights; writes what lights add to the mean radiance of each free pixel,
// irradiance across the beam over the full circle; or adds what the floor sends up of them. One thread is one pixel.
#version 430 core
#include "delta.h"
#include "floor.h"

layout(local_size_x = kDeltaGroupX, local_size_y = kDeltaGroupY) in;
layout(std140, binding = kDeltaParamsBinding) uniform Params { DeltaParams params; };
layout(binding = kDeltaDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kDeltaHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kDeltaEntriesUnit) uniform samplerBuffer entries;
layout(binding = kDeltaLightsUnit) uniform samplerBuffer lights;
layout(binding = kDeltaRadianceImage, rgba32f) uniform image2D radiance_image;

// Which program this is: whether it adds what a floor sends up, which depends on where light comes from.
const int kFloor = 1;

#include "lib/delta.glsl"
#include "lib/media.glsl"
#include "lib/floor.glsl"

vec3 sent_up(FloorPlace place, Arrival arrival) {
    float far = length(arrival.way);
    vec2 level = far > 0.0 ? arrival.way / far : vec2(0.0);
    if (arrival.up > 0.0) return arrival.across * floor_beam(place, vec3(level * sqrt(max(1.0 - arrival.up * arrival.up, 0.0)), arrival.up));
    vec3 mean = arrival.on_floor * 0.15915494309189535;
    return floor_field(place, mean, mean * level.x, mean * level.y);
}

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
    FloorPlace floor_place;
    if (kFloor != 0) floor_place = floor_at(place);
    int end_light = room > 0.0 ? params.end_light : params.first_light;
    for (int light = params.first_light; light < end_light; ++light) {
        uvec4 head = texelFetch(heads, list + light);
        Arrival arrival = arrival_at(light, p, params.least_distance);
        bool dark = head.x == kDeltaDark || all(equal(arrival.on_floor, vec3(0.0)));
        if (!dark && !list_hides(head, p, arrival.way, arrival.end)) {
            vec3 light = kFloor != 0 ? sent_up(floor_place, arrival) : arrival.on_floor * 0.15915494309189535;
            if (kSceneMedia != 0) {
                float far = length(arrival.way);
                vec3 gained, through;
                int budget = kDeltaMediaBudget;
                // The box of all media ends the way to what has no distance.
                bool arrived = cross_media(p, arrival.way / max(far, 1e-20), 0.0, arrival.end > 1.0 ? kFar : far, budget, gained, through);
                light *= arrived ? through : vec3(0.0);
            }
            sum += light;
        }
    }
    vec4 radiance = params.adds != 0 ? imageLoad(radiance_image, place) : vec4(0.0, 0.0, 0.0, 1.0);
    imageStore(radiance_image, place, radiance + vec4(sum, 0.0));
}
