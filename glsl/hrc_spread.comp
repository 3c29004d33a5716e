// Reads the fluence of each lattice point, distance and material; writes each pixel's mean radiance, interpolated between the
// lattice points that its centre sees. One thread is one pixel.
#version 430 core
#include "cascade.h"
#include "hrc.h"
#include "lib/march.glsl"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kHrcSumUnit) uniform sampler2D sum_texture;

const float kTurn = 6.28318530717958648;

float room_at(vec2 p) {
    return texelFetch(distance_texture, clamp(ivec2(floor(p)) + params.border, ivec2(0), textureSize(distance_texture, 0) - 1), 0).r;
}

vec4 light_at(ivec2 point) { return texelFetch(sum_texture, clamp(point, ivec2(0), params.points - 1), 0); }

vec2 place_of(ivec2 point) { return params.first_point + params.cell * vec2(clamp(point, ivec2(0), params.points - 1)); }

// Whether nothing stands between the pixel's centre and a lattice point.
bool sees(vec2 p, ivec2 point, inout int budget) {
    vec2 way = place_of(point) - p;
    float far = length(way);
    vec3 radiance;
    return far < 1e-3 || march(p, way / far, 0.0, far, params.domain, params.border, budget, radiance) != kRayBlocked;
}

// Whether that is still to be found out: not of a point inside a shape, which has no light to give, nor where free discs about the
// two overlap.
bool in_doubt(vec2 p, float room, ivec2 point) {
    vec2 place = place_of(point);
    return light_at(point).a > 0.0 && room + room_at(place) - kHalfDiagonal <= distance(p, place);
}

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec2 p = vec2(pixel) + 0.5;
    vec2 at = (p - params.first_point) / params.cell;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    float room = room_at(p);
    // Farther from all shapes than from the four lattice points it sees them all.
    bool open = room <= 0.0 || room > 1.4143 * params.cell;
    int budget = kMarchBudget;
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    // A bit each: a vector of the device's marches as often as one of its pixels is in doubt, not four times.
    uint doubts = 0u, hidden = 0u;
    for (int k = 0; k < 4; ++k)
        if (!open && weights[k] > 0.0 && in_doubt(p, room, base + ivec2(k & 1, k >> 1))) doubts |= 1u << k;
    while (doubts != 0u) {
        int k = findLSB(doubts);
        doubts &= doubts - 1u;
        if (!sees(p, base + ivec2(k & 1, k >> 1), budget)) hidden |= 1u << k;
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; ++k) {
        vec4 light = light_at(base + ivec2(k & 1, k >> 1));
        float weight = ((hidden >> k) & 1u) != 0u ? 0.0 : weights[k] * light.a;
        sum += weight * vec4(light.rgb, 1.0);
    }
    // Where it sees none, those around them.
    const uint inner = 0x660u;  // of four by four, the four that were asked
    uint around = open || sum.a > 0.0 ? 0u : 0xffffu & ~inner;
    doubts = 0u;
    for (int k = around != 0u ? 0 : 16; k < 16; ++k)
        if (((around >> k) & 1u) != 0u && in_doubt(p, room, base + ivec2(k & 3, k >> 2) - 1)) doubts |= 1u << k;
    while (doubts != 0u) {
        int k = findLSB(doubts);
        doubts &= doubts - 1u;
        if (!sees(p, base + ivec2(k & 3, k >> 2) - 1, budget)) around &= ~(1u << k);
    }
    while (around != 0u) {
        int k = findLSB(around);
        around &= around - 1u;
        ivec2 step = ivec2(k & 3, k >> 2) - 1;
        vec2 away = vec2(step) - f;
        vec4 light = light_at(base + step);
        sum += light.a / dot(away, away) * vec4(light.rgb, 1.0);
    }
    imageStore(radiance_image, pixel, sum.a > 0.0 ? vec4(sum.rgb / (sum.a * kTurn), 1.0) : vec4(0.0));
}
