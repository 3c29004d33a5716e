#ifndef PENUMBRA_GLSL_DELTA_H
#define PENUMBRA_GLSL_DELTA_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

// Point, spot and directional lights (docs/methods/delta-lights.md): lists of what may stand between a tile and a light, and
// the light that arrives.
const int kDeltaGroupX = 64;  // Mesa 22 vectorises along x only
const int kDeltaGroupY = 1;
const int kDeltaParamsBinding = 0;

const int kDeltaTile = 16;    // pixels across a tile

// Texture units.
const int kDeltaDistanceUnit = 4;
const int kDeltaHeadsUnit = 5;    // RGBA32UI: one list of each tile and light
const int kDeltaEntriesUnit = 6;  // RGBA32F: pieces of outline, as in glsl/exact.h
const int kDeltaLightsUnit = 7;   // RGBA32F, kDeltaLightTexels a light:
                                  //   position, kind, height | intensity, tilt (rad) | direction, inner, outer half angle (rad)
const int kDeltaJobsUnit = 12;    // R32UI: the tile of four nodes
const int kDeltaNodesUnit = 15;   // RGBA32F: as in glsl/exact.h

const int kDeltaLightTexels = 3;
// Kinds of lights. A directional light's position is the direction towards it; its height and tilt are the sine and the cosine of
// its elevation.
const int kDeltaPoint = 0;
const int kDeltaSpot = 1;
const int kDeltaDirectional = 2;
const int kDeltaRaised = 4;       // added to a kind: of the world above the canvas, where light falls with the square

const int kDeltaMediaBudget = 4000;  // loop iterations in media, of one light

const int kDeltaRadianceImage = 0;
const int kDeltaNodeRow = 1024;  // kExactNodeRow
// Places on an element that are asked: shadows have hard edges, and the mean over an element counts.
const int kDeltaSamples = 8;

const int kDeltaHeadsStorage = 0;
const int kDeltaEntriesStorage = 1;
const int kDeltaCountersStorage = 2;
const int kDeltaCountEntries = 0;  // texels of entries that lists reserved
const int kDeltaCountMost = 1;     // most pieces in one list, or kDeltaTooLong
const uint kDeltaTooLong = 0x7fffffffu;

// A list's head: first texel, straight pieces | discs << 16, arcs | ellipses << 16, unused. Without pieces the first texel is
// kDeltaOpen, or kDeltaDark where no light arrives anywhere in the tile.
const uint kDeltaOpen = 0xfffffffeu;
const uint kDeltaDark = 0xffffffffu;

struct DeltaParams {
    ivec2 origin;
    ivec2 extent;
    ivec2 border;       // grid pixels left of and above the view
    ivec2 tiles;        // of the lists that are made or read
    ivec2 parent_tiles;
    ivec2 list_origin;  // px, of the first tile
    int tile_px;
    int parent_ratio;   // tiles a parent tile is across; 0: one list for all
    int lights;         // of the lists
    int first_light;    // that this dispatch adds
    int end_light;
    int capacity;       // texels of entries
    int first_row;      // of the band, in the image
    int jobs;
    ivec4 root_counts;  // of the one list of all pieces, by kind
    int adds;           // to what an earlier dispatch found
    float least_distance;  // px: lights count as at least so far
    int pad0;
    int pad1;
};

#ifdef __cplusplus
}
#endif
#endif
