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
const int kTileRangesUnit = 4;        // rg32i: first and end in the list of a tile
const int kTileShapesUnit = 5;        // r32i: the shapes of all lists

// Side of a tile that has its own list of shapes, px. A vector of invocations lies in one tile.
const int kDistanceTile = 8;

struct DistanceParams {
    ivec2 origin;       // first pixel of this slice, in grid pixels
    ivec2 extent;       // grid size
    ivec2 border;       // grid pixels left of and above the view
    int first_shape;    // this slice's shapes
    int end_shape;
    int continues;      // 1: merge with what earlier slices wrote
    float far_px;       // distance of an empty scene: the grid's diagonal (errata E-2)
    int tiles;          // along x; 0: no lists, this slice's shapes are asked
    int first_range;    // of this slice's lists
};

#ifdef __cplusplus
}
#endif
#endif
