#ifndef PENUMBRA_GLSL_COMPOSE_H
#define PENUMBRA_GLSL_COMPOSE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kComposeGroupX = 16;
const int kComposeGroupY = 4;
const int kComposeParamsBinding = 0;
const int kComposeImageBinding = 0;  // rgba8 or rgba16 (display) or rgba32f (linear)
const int kComposeRadianceUnit = 6;  // mean radiance, one texel a pixel
const int kComposeDistanceImage = 1;  // r32f: what loads from an image takes a third of a fetch from a texture on Mesa 22
const int kComposeMaterialImage = 2;  // r32i
const int kComposeLightsUnit = 7;    // what point, spot and directional lights add, or one texel without them
const int kComposeLitUnit = 8;       // what solid pixels reflect, one texel a pixel; one black texel: nothing
const int kComposeLutUnit = 9;       // a tone curve of kTonemapTony: its slices, one below the other

const int kTonemapNone = 0;
const int kTonemapReinhard = 1;
const int kTonemapReinhardExtended = 2;
const int kTonemapAces = 3;
const int kTonemapAgx = 4;
const int kTonemapPbrNeutral = 5;
const int kTonemapAcesNarkowicz = 6;
const int kTonemapTony = 7;
const int kLookNone = 0;
const int kLookGolden = 1;
const int kLookPunchy = 2;

// Set for each program: it holds the one curve that the scene asks for.
const int kComposeTonemap = kTonemapNone;
const int kComposeLook = kLookNone;
const int kComposeDither = 0;

struct ComposeParams {
    ivec2 origin;
    ivec2 extent;        // canvas
    ivec2 border;        // grid pixels left of and above the view
    int antialias;
    int levels;          // the largest code: 255 or 65535
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
