// What surfaces shine with when light bounces: core/plan/surface_cells.cpp writes it, lib/surface_light.glsl reads it.
#ifndef PENUMBRA_GLSL_SURFACE_RECORDS_H
#define PENUMBRA_GLSL_SURFACE_RECORDS_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

const int kSurfaceHeadsUnit = 8;   // RG32UI: cells along x and y; then, cell by cell, the first and the end of its chords
const int kSurfaceChordsUnit = 9;  // RGBA32F: kSurfaceChordTexels a chord
// A chord's texels: ends a and b, px, with free space on the right of the way from a to b | radiance in the middle, unused |
// its change from a to b, unused.
const int kSurfaceChordTexels = 3;

const int kSurfaceCell = 4;           // px
const float kSurfaceReach = 1.5;      // px: chords are listed in cells that they come as near to; a march ends as near to them
const int kMostSurfaceChords = 256;   // of one cell: loops end

#ifdef __cplusplus
}
#endif
#endif
