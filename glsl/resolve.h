#ifndef PENUMBRA_GLSL_RESOLVE_H
#define PENUMBRA_GLSL_RESOLVE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kResolveGroupX = 64;
const int kResolveGroupY = 1;
const int kResolveParamsBinding = 0;
const int kResolveImageBinding = 0;
const int kResolveCascadeUnit = 6;

struct ResolveParams {
    ivec2 origin;
    ivec2 extent;      // pixels whose light is asked for
    ivec2 probes;      // of cascade 0
    ivec2 tiles;       // direction groups of cascade 0
    vec2 texel;        // 1 / texture size
    vec2 first_probe;  // px
    float spacing;     // px
    int aligned;       // 1: a probe at each pixel's centre, nothing to interpolate
    ivec2 first_pixel; // of the canvas
};

#ifdef __cplusplus
}
#endif
#endif
