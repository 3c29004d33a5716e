#ifndef PENUMBRA_GLSL_JUMP_H
#define PENUMBRA_GLSL_JUMP_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kJumpGroupX = 16;
const int kJumpGroupY = 4;
const int kJumpParamsBinding = 0;
const int kJumpImageBinding = 0;       // rg16i: nearest seed, or kNoSeed
const int kJumpDistanceBinding = 1;    // r32f, read and written by the merge
const int kJumpSeedsUnit = 4;          // rg16i texture
const int kJumpMaterialUnit = 5;       // r32i texture
const int kNoSeed = -32768;

// Where only what is near a bitmap matters, no jumps: a window of so many pixels to each side is searched, columns then rows.
const int kNearSeeds = 6;
const int kNearTile = 8;           // a row of invocations is a tile
const int kNearSeedsImage = 0;     // r8ui: 1 where a bitmap shows
const int kNearColumnsImage = 2;   // r8ui: kNearSeeds + 1 less the way up or down to the nearest such pixel; 0: none so near
const int kNearTilesUnit = 4;      // rg32i: first pixel of each tile

// The programs of jump flooding and of the window share these; the window's dispatches are of `step` tiles.
struct JumpParams {
    ivec2 origin;  // first pixel of this slice
    ivec2 extent;  // grid size
    int step;      // jump length in pixels
    int pad0;
    int pad1;
    int pad2;
};

#ifdef __cplusplus
}
#endif
#endif
