// Reads level 0's fluences of a quadrant; adds them up for each lattice point of the view. One thread is a lattice point;
// x runs along the quadrant's rows.
#version 430 core
#include "hrc.h"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(rgba32f, binding = kHrcImageBinding) uniform image2D sum_image;
layout(binding = kHrcFluenceUnit) uniform sampler2D fluence_texture;

void main() {
    ivec2 id = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (id.x >= params.extent.x || id.y >= params.extent.y) return;
    ivec2 point = params.corner + id.x * params.row_step + id.y * params.column_step;
    vec4 sum = params.is_first != 0 ? vec4(0.0, 0.0, 0.0, 1.0) : imageLoad(sum_image, point);
    for (int cone = 0; cone < params.cones; ++cone)
        sum.rgb += texelFetch(fluence_texture, ivec2(id.x + params.row_border, id.y * params.cones + cone), 0).rgb;
    imageStore(sum_image, point, sum);
}
