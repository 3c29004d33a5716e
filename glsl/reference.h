#ifndef PENUMBRA_GLSL_REFERENCE_H
#define PENUMBRA_GLSL_REFERENCE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kReferenceGroupX = 16;
const int kReferenceGroupY = 4;
const int kReferenceParamsBinding = 0;
const int kReferenceImageBinding = 0;   // rgba32f, the sum so far
const int kReferenceDistanceUnit = 4;   // r32f

// Loop iterations at the end of a ray and in media at most: as many as the plan counts (core/plan/plan.cpp).
const int kReferenceBudget = 10000;

struct ReferenceParams {
    ivec2 origin;     // first pixel of this slice
    ivec2 extent;     // pixels whose light is asked for
    ivec2 border;     // grid pixels left of and above the view
    int shape_count;
    int ray_count;    // of the whole picture, per pixel
    int first_ray;    // this dispatch's rays
    int end_ray;
    int sky_first;    // sector table of ray_count sectors, -1: constant sky
    int is_last;      // divide the sum by ray_count
    vec4 domain;      // x0 y0 x1 y1, pixels of the view
    vec4 sky;
    ivec2 first_pixel; // of the canvas
    ivec2 pad0;
};

#ifdef __cplusplus
}
#endif
#endif
