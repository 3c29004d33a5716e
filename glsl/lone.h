#ifndef PENUMBRA_GLSL_LONE_H
#define PENUMBRA_GLSL_LONE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kLoneGroupX = 64;
const int kLoneGroupY = 1;
const int kLoneParamsBinding = 0;
const int kLoneImageBinding = 0;
const int kLoneRadianceUnit = 6;  // the same texture: a is 0 where a pixel has no light yet
const int kLoneRays = 64;

struct LoneParams {
    ivec2 origin;
    ivec2 extent;       // pixels of the texture
    ivec2 border;       // grid pixels left of and above the view
    ivec2 first_pixel;  // of the canvas
    vec4 domain;        // x0 y0 x1 y1, pixels of the view
    vec4 sky;           // its mean over all directions
};

#ifdef __cplusplus
}
#endif
#endif
