#ifndef PENUMBRA_GLSL_HRC_H
#define PENUMBRA_GLSL_HRC_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

// Ray pieces and fluences lie row innermost: texel (row, plane * rays + ray) or (row, plane * cones + cone), so that
// neighbouring invocations read and write neighbouring texels.
const int kHrcGroupX = 64;  // Mesa 22 vectorises along x only
const int kHrcGroupY = 1;
const int kHrcParamsBinding = 0;
const int kHrcImageBinding = 0;
const int kHrcListBinding = 1;   // r32ui: row and slot of rays to be traced, in lines of kHrcListWidth
const int kHrcCountBinding = 2;  // r32ui: how many
const int kHrcListWidth = 4096;  // a power of two
const int kHrcListUnit = 7;
const int kHrcPiecesBinding = 3;  // rgba: radiance met, transmittance
const int kHrcUpperBinding = 4;   // rgb: the next level's fluence per cone
const int kHrcFluenceUnit = 7;    // rgb: level 0's
const int kHrcSumUnit = 6;      // rgb: fluence of all quadrants
const int kHrcDistanceUnit = 4;  // r32f

// The programs of holographic radiance cascades share these (docs/methods/hrc.md). All counts are of one quadrant.
struct HrcParams {
    ivec2 origin;       // first invocation of this slice
    ivec2 extent;       // invocations
    ivec2 border;       // grid pixels left of and above the view
    int rows;           // of the lattice
    int stride;         // columns between planes of this level
    int climb;          // rows between the ends of neighbouring rays
    int jobs;           // invocations a plane: rays or cones
    float per_job;      // 1 / jobs
    int rays;           // of the pieces written
    int lower_planes;   // of the pieces read
    int lower_rays;
    int compose;        // 1 where the even rays are put together from the level below, 0 at level 0
    int first_plane;    // merging: 0 the even planes, 1 the odd ones
    int cones;          // of the fluences written
    int upper_planes;   // of the fluences read, 0: nothing but the sky
    int upper_cones;
    int upper_first;    // their first cone in the table
    int piece_step;     // plane p of this parity has its pieces in plane piece_step * p + first_plane,
    int ray_step;       // its ray k in ray_step * k
    int leap;           // planes to the next one that the level above has: 1 or 2
    int own_terms;      // 2: mixed half and half with what the level above has at this very point
    ivec2 points;       // of the lattice, in the view
    ivec2 corner;       // the view's lattice point in its first row, column 0
    ivec2 row_step;     // to the next row's
    ivec2 column_step;  // to the next column's
    int row_border;     // rows before the view's first
    int is_first;       // quadrant to be added up
    int listed;         // rays on the list
    int pad0;
    vec2 first;         // lattice point (0, 0), px of the view
    vec2 along;         // px a column
    vec2 across;        // px a row
    vec2 first_point;   // of the view's lattice, px
    vec4 domain;        // x0 y0 x1 y1, px of the view
    float cell;         // px
    float blur;         // weight of each of four neighbours beside the pixel's own of 1
    int pad1;
    int pad2;
};

#ifdef __cplusplus
}
#endif
#endif
