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

// The three programs of jump flooding share these.
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
