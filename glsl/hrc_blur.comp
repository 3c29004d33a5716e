// Reads the fluence of each lattice point, of which every pixel's centre is one, and the distance; writes each pixel's mean
// radiance: its own, mixed with those of the four neighbours in plain view, since neighbours meet different rays. One thread
// is one pixel.
#version 430 core
#include "hrc.h"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D radiance_image;
layout(binding = kHrcSumUnit) uniform sampler2D sum_texture;
layout(binding = kHrcDistanceUnit) uniform sampler2D distance_texture;

const float kTurn = 6.28318530717958648;

float room_at(ivec2 pixel) {
    return texelFetch(distance_texture, clamp(pixel + params.border, ivec2(0), textureSize(distance_texture, 0) - 1), 0).r;
}

// Free discs about two points one pixel apart that overlap leave no room for a wall between them.
vec4 neighbour(ivec2 pixel, ivec2 step, float room) {
    ivec2 other = clamp(pixel + step, ivec2(0), params.points - 1);
    float weight = other == pixel + step && room + room_at(other) > 1.0 ? params.blur : 0.0;
    return weight * vec4(texelFetch(sum_texture, other, 0).rgb, 1.0);
}

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    float room = room_at(pixel);
    vec4 sum = vec4(texelFetch(sum_texture, pixel, 0).rgb, 1.0);
    sum += neighbour(pixel, ivec2(1, 0), room) + neighbour(pixel, ivec2(-1, 0), room);
    sum += neighbour(pixel, ivec2(0, 1), room) + neighbour(pixel, ivec2(0, -1), room);
    imageStore(radiance_image, pixel, vec4(sum.rgb / (sum.a * kTurn), 1.0));
}
