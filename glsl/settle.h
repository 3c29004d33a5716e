#ifndef PENUMBRA_GLSL_SETTLE_H
#define PENUMBRA_GLSL_SETTLE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kSettleGroupX = 8;
const int kSettleParamsBinding = 0;
const int kSettleImageBinding = 0;
const int kSettleUnits = 16;  // what GL promises to every program

struct SettleParams {
    ivec2 origin;
    ivec2 extent;
};

#ifdef __cplusplus
}
#endif
#endif
