#ifndef PENUMBRA_GLSL_CLOSED_H
#define PENUMBRA_GLSL_CLOSED_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kClosedGroupX = 64;
const int kClosedGroupY = 1;
const int kClosedParamsBinding = 0;
const int kClosedDistanceImage = 0;  // r32f
const int kClosedMaterialImage = 1;  // r32i
const int kClosedTilesUnit = 6;      // RG32UI: first pixel of each tile
const float kClosedDistance = -64.0; // px: deep inside

struct ClosedParams {
    ivec2 origin;
    ivec2 extent;   // pixels of a tile, tiles
    ivec2 canvas;
    ivec2 border;   // grid pixels left of and above the view
    int tile;       // px across
    int pad0;
    int pad1;
    int pad2;
};

#ifdef __cplusplus
}
#endif
#endif
