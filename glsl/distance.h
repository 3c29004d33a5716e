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
const int kTileJobsUnit = 4;          // rgba32i: a tile's first pixel, and first and end of its list
const int kTileShapesUnit = 5;        // r32i: the shapes of all lists

// Side of a tile that has its own list of shapes, px. A vector of invocations is a row of one tile.
const int kDistanceTile = 8;

// 1: a row of invocations is a tile, which asks its own list. 0: a row of the grid, which asks all shapes of the slice.
const int kDistanceByTiles = 0;

struct DistanceParams {
    ivec2 origin;       // first pixel of this slice, in grid pixels
    ivec2 extent;       // grid size
    ivec2 border;       // grid pixels left of and above the view
    int first_shape;    // this slice's shapes
    int end_shape;
    int continues;      // 1: merge with what earlier slices wrote
    float far_px;       // distance of an empty scene: the grid's diagonal (errata E-2)
    int jobs;           // tiles that ask
    int pad0;
};

#ifdef __cplusplus
}
#endif
#endif
