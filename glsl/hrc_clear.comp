// Reads distance and material; writes each lattice point's sum before the quadrants: nothing in rgb, in a 1 in free space and
// 0 in a shape. One thread is a lattice point. Not run where lattice points are pixels' centres.
#version 430 core
#include "cascade.h"
#include "hrc.h"
#include "lib/march.glsl"

layout(local_size_x = kHrcGroupX, local_size_y = kHrcGroupY) in;
layout(std140, binding = kHrcParamsBinding) uniform Params { HrcParams params; };
layout(binding = kHrcImageBinding) writeonly uniform image2D sum_image;

void main() {
    ivec2 point = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (point.x >= params.extent.x || point.y >= params.extent.y) return;
    bool inside = starts_inside(params.first_point + params.cell * vec2(point), params.border);
    imageStore(sum_image, point, vec4(0.0, 0.0, 0.0, inside ? 0.0 : 1.0));
}
