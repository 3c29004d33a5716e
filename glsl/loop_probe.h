#ifndef PENUMBRA_GLSL_LOOP_PROBE_H
#define PENUMBRA_GLSL_LOOP_PROBE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kLoopProbeParamsBinding = 0;
const int kLoopProbeImageBinding = 0;  // r32i, 8 x 1: iterations made

struct LoopProbeParams {
    ivec2 origin;
    int iterations;  // wanted
    int pad0;
};

#ifdef __cplusplus
}
#endif
#endif
