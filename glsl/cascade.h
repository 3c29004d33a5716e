#ifndef PENUMBRA_GLSL_CASCADE_H
#define PENUMBRA_GLSL_CASCADE_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kCascadeGroupX = 64;  // Mesa 22 vectorises along x only
const int kCascadeGroupY = 1;
const int kCascadeParamsBinding = 0;
const int kCascadeImageBinding = 0;
const int kCascadeDistanceUnit = 4;  // r32f
const int kCascadeMaterialUnit = 5;  // r32i
const int kCascadeUpperUnit = 6;     // rgba, linear filter, the cascade above

// Loop iterations of one invocation, its four rays and all inner loops together: under the 65535 after which
// Mesa 22 ends every loop. A ray that finds them spent is blocked, never free (errata E-5).
// It is half of that, because the eight invocations of a vector wait for each other's loops.
const int kMarchBudget = 32000;
const int kLostRaysStorage = 5;  // one uint: rays of the frame that ran out of steps
// Outlines of more edges than this are not asked during a march; the distance is interpolated instead.
const int kMostMarchedEdges = 24;

struct CascadeParams {
    ivec2 origin;       // first texel of this slice
    ivec2 extent;       // texture size: probes * tiles
    ivec2 probes;       // probe grid
    ivec2 upper_probes; // of the cascade above
    ivec2 border;       // grid pixels left of and above the view
    ivec2 tiles;        // direction groups along x and y
    ivec2 upper_tiles;
    vec2 upper_texel;   // 1 / size of the texture above
    vec2 first_probe;   // centre of probe (0, 0), pixels of the view
    vec2 upper_first;   // centre of the upper probe (0, 0)
    vec4 domain;        // x0 y0 x1 y1, pixels of the view
    vec4 offset_cos;    // cosines of the four rays' angles from their group's centre
    vec4 offset_sin;
    vec4 sky;           // constant sky radiance
    float spacing;      // between probes, px
    float upper_spacing;
    float start;        // interval along the ray, px
    float end;
    float group_angle;  // 2 pi / direction groups
    int is_last;        // nothing above: the sky ends the ray
    int sky_first;      // first sector of this cascade in the sky table, -1: constant sky
    int pad0;
};

#ifdef __cplusplus
}
#endif
#endif
