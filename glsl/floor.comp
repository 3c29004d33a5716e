// Reads the light that arrives at each pixel and what the floor is made of there; writes what it sends up. One thread is one pixel.
#version 430 core
#include "floor.h"

layout(local_size_x = kFloorGroupX, local_size_y = kFloorGroupY) in;
layout(std140, binding = kFloorParamsBinding) uniform Params { FloorParams params; };
layout(binding = kFloorRadianceUnit) uniform sampler2D radiance_texture;
layout(binding = kFloorLightsUnit) uniform sampler2D lights_texture;
layout(binding = kFloorMomentXUnit) uniform sampler2D moment_x_texture;
layout(binding = kFloorMomentYUnit) uniform sampler2D moment_y_texture;
layout(binding = kFloorImage, rgba32f) writeonly uniform image2D floor_image;

// Which program this is: whether it matters where light comes from.
const int kRelief = 1;

#include "lib/floor.glsl"

void main() {
    ivec2 at = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.extent.x || at.y >= params.extent.y) return;
    ivec2 from = min(at + params.first_pixel, textureSize(radiance_texture, 0) - 1);
    vec3 mean = texelFetch(radiance_texture, from, 0).rgb * params.radiance_scale;
    vec3 sent;
    if (kRelief == 0) {
        sent = floor_albedo_at(at) * (mean + texelFetch(lights_texture, min(at, textureSize(lights_texture, 0) - 1), 0).rgb);
    } else {
        vec3 x = texelFetch(moment_x_texture, min(at, textureSize(moment_x_texture, 0) - 1), 0).rgb * params.radiance_scale;
        vec3 y = texelFetch(moment_y_texture, min(at, textureSize(moment_y_texture, 0) - 1), 0).rgb * params.radiance_scale;
        sent = floor_field(floor_at(at), mean, x, y);
    }
    imageStore(floor_image, at, vec4(sent, 1.0));
}
