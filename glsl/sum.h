#ifndef PENUMBRA_GLSL_SUM_H
#define PENUMBRA_GLSL_SUM_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kSumGroupX = 64;
const int kSumGroupY = 1;
const int kSumParamsBinding = 0;
const int kSumImageBinding = 0;
const int kSumSampledUnit = 6;
const int kSumSolvedUnit = 7;

struct SumParams {
    ivec2 origin;
    ivec2 extent;     // of what was sampled
    ivec2 first_lit;  // the pixel of the first texel of what was solved
    ivec2 unused;
};

#ifdef __cplusplus
}
#endif
#endif
