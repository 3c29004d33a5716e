#ifndef PENUMBRA_GLSL_RC_FIX_H
#define PENUMBRA_GLSL_RC_FIX_H
#include "types.h"
#include "cascade.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

// Units, bindings and the budget of the march are those of cascade.h.
const int kRcFixGroupX = 64;  // Mesa 22 vectorises along x only
const int kRcFixGroupY = 1;

struct RcFixParams {
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
    float start;        // where this cascade's rays begin and where the cascade above begins, px
    float end;
    float group_angle;  // 2 pi / direction groups
    float longest;      // no ray of this cascade is longer, px
    int pad0;
    int sky_first;      // first sector of this cascade in the sky table, -1: constant sky
};

#ifdef __cplusplus
}
#endif
#endif
