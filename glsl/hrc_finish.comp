// Reads the fluence of each lattice point, and the distance; writes each pixel's mean radiance. Where lattice points are pixels'
// centres, mixed with those of the four neighbours in plain view (the odd and even rows of the lattice meet different rays);
// else interpolated between points in free space. One thread is one pixel.
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

vec4 weighted(ivec2 point, float weight) {
    bool inside = all(greaterThanEqual(point, ivec2(0))) && all(lessThan(point, params.points));
    vec4 sum = texelFetch(sum_texture, clamp(point, ivec2(0), params.points - 1), 0);
    return inside && sum.a > 0.0 ? weight * sum : vec4(0.0);
}

// Free discs about two points one pixel apart that overlap leave no room for a wall between them.
vec4 neighbour(ivec2 pixel, ivec2 step, float room) {
    return weighted(pixel + step, room + room_at(pixel + step) > 1.0 ? params.blur : 0.0);
}

void main() {
    ivec2 pixel = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.extent.x || pixel.y >= params.extent.y) return;
    vec4 sum;
    if (params.aligned != 0) {
        float room = room_at(pixel);
        sum = weighted(pixel, 1.0);
        sum += neighbour(pixel, ivec2(1, 0), room) + neighbour(pixel, ivec2(-1, 0), room);
        sum += neighbour(pixel, ivec2(0, 1), room) + neighbour(pixel, ivec2(0, -1), room);
    } else {
        vec2 at = (vec2(pixel) + 0.5 - params.first_point) / params.cell;
        ivec2 base = ivec2(floor(at));
        vec2 f = at - vec2(base);
        sum = weighted(base, (1.0 - f.x) * (1.0 - f.y)) + weighted(base + ivec2(1, 0), f.x * (1.0 - f.y)) +
              weighted(base + ivec2(0, 1), (1.0 - f.x) * f.y) + weighted(base + ivec2(1, 1), f.x * f.y);
    }
    imageStore(radiance_image, pixel, sum.a > 0.0 ? vec4(sum.rgb / (sum.a * kTurn), 1.0) : vec4(0.0));
}
