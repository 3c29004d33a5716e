#ifndef PENUMBRA_GLSL_DISTANCE_H
#define PENUMBRA_GLSL_DISTANCE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kDistanceGroupX = 16;
const int kDistanceGroupY = 4;
const int kDistanceParamsBinding = 0;
const int kDistanceImageBinding = 0;  // r32f
const int kMaterialImageBinding = 1;  // r32i

struct DistanceParams {
    ivec2 origin;       // first pixel of this slice, in grid pixels
    ivec2 extent;       // grid size
    ivec2 border;       // grid pixels left of and above the view
    int first_shape;    // this slice's shapes
    int end_shape;
    int continues;      // 1: merge with what earlier slices wrote
    float far_px;       // distance of an empty scene: the grid's diagonal (errata E-2)
    int pad0;
    int pad1;
};

#ifdef __cplusplus
}
#endif
#endif
