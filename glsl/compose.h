#ifndef PENUMBRA_GLSL_COMPOSE_H
#define PENUMBRA_GLSL_COMPOSE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kComposeGroupX = 16;
const int kComposeGroupY = 4;
const int kComposeParamsBinding = 0;
const int kComposeImageBinding = 0;  // rgba8 (display) or rgba32f (linear)
const int kComposeRadianceUnit = 6;  // mean radiance, one texel a pixel
const int kComposeDistanceUnit = 4;
const int kComposeMaterialUnit = 5;
const int kComposeLightsUnit = 7;    // what point, spot and directional lights add, or one texel without them

const int kTonemapNone = 0;
const int kTonemapReinhard = 1;
const int kTonemapReinhardExtended = 2;
const int kTonemapAces = 3;
const int kTonemapAgx = 4;
const int kTonemapPbrNeutral = 5;

struct ComposeParams {
    ivec2 origin;
    ivec2 extent;        // canvas
    ivec2 border;        // grid pixels left of and above the view
    int antialias;
    int tonemap;
    vec4 floor_albedo;
    float exposure;      // factor, 2^EV
    float radiance_scale; // what the radiance texture must be multiplied with
    float white;         // Reinhard extended: the radiance that becomes 1
    int has_shapes;
    ivec2 first_pixel;   // of the canvas in the image: parts of it, and bands of tall pictures
    ivec2 first_lit;     // the pixel of the radiance's first texel
};

#ifdef __cplusplus
}
#endif
#endif
