#ifndef PENUMBRA_GLSL_EXACT_H
#define PENUMBRA_GLSL_EXACT_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

// The method `exact` (docs/methods/exact-gpu.md): its lists, points and cells.
const int kExactGroupX = 64;  // Mesa 22 vectorises along x only
const int kExactGroupY = 1;
// The solver: jobs of four points in a group, threads of a group, and threads that share a point's sectors. One: a thread solves
// four points at once; more, on a GPU: a thread takes some of the sectors of one point.
const int kExactSolveGroupX = 32;
const int kExactSolveThreads = 32;
const int kExactLanes = 1;
const int kExactParamsBinding = 0;

// Pixels across a tile, whose points share lists, and across the largest cells. The last tiles' points include those of the
// column and row beyond, so that every cell has four corners.
const int kExactTile = 16;
const int kExactCell = 8;
const int kExactTileRows = kExactTile + 1;  // of points, of the last tiles

// Texture units (0 to 3 are the scene's).
const int kExactDistanceUnit = 4;
const int kExactHeadsUnit = 5;        // RGBA32UI: one list of each tile and sector; see exact_lists.comp
const int kExactEntriesUnit = 6;      // RGBA32F: geometry of the pieces of the lists
const int kExactLightsUnit = 7;       // RGBA32F: radiance of an entry's piece, and which piece it is
const int kExactSectorsUnit = 9;      // RGBA32F: cos and sin of the sector's axis, its angle, unused
const int kExactSkyUnit = 10;         // RGBA32F: two texels a node: sky integral from angle 0, sky radiance and part
const int kExactAsksUnit = 11;        // R32UI: a word for each row of a tile, a bit for each point that is asked for
const int kExactCellsUnit = 11;       // R32UI: x | y << 16 of the cells of the level before that were split
const int kExactPointsUnit = 11;      // R32UI: x | y << 8 in the tile, tile by tile
const int kExactValueUnit = 8;
const int kExactJobsUnit = 12;        // R32UI: tile | four points of it << 24; of surfaces: tile
const int kExactSurfacesUnit = 13;    // RGBA32F: a texel for each piece, see below
const int kExactElementsUnit = 14;    // RGBA32F: kExactElementTexels for each element of each piece, and one element more
const int kExactNodesUnit = 15;       // RGBA32F: where surfaces are solved, job by job

// Images.
const int kExactValueImage = 0;   // rgb mean radiance, a: signature of what is seen
const int kExactSlopeXImage = 1;  // rgb its slope along x per pixel, a: bound on its third derivatives
const int kExactSlopeYImage = 2;  // rgb its slope along y, a: sectors that are done
const int kExactRadianceImage = 5;
const int kExactLeafImage = 4;    // R32UI: at the first pixel of each cell that was looked at: size of the smallest cell there

// Storage.
const int kExactHeadsStorage = 0;
const int kExactEntriesStorage = 1;
const int kExactLightsStorage = 2;
const int kExactPointsStorage = 3;
const int kExactCountersStorage = 4;
const int kExactJobsStorage = 5;
const int kExactAsksStorage = 6;
const int kExactCellsStorage = 7;  // of exact_split.comp
const int kExactToldStorage = 7;   // of the lists and the solver

// Counters, in uints. From kExactCountLevel on, four a level: the solver's jobs, and the groups of its dispatch. From
// kExactCountTiles on, level by level: how many points each tile asks for.
const int kExactCountLevel = 4;
const int kExactCountCells = 20;      // and level, but for the last: cells that were split
const int kExactCountTiles = 24;
// What the host is told, in uints, in a buffer that nothing else uses: one driver (NVIDIA 580) reads counters that are also the group
// counts of a dispatch back as they were before it. Two of each kind of lists.
const int kExactToldEntries = 0;    // texels of entries that lists reserved
const int kExactToldWork = 1;       // most loop iterations that one list may take, or kExactTooLong
const int kExactToldSpent = 4;      // points whose loops ran out
const int kExactToldUnfinished = 5; // points that go on in another dispatch
const int kExactToldCount = 8;

// Kinds of pieces, in the order in which a list holds them. Texels of an entry:
//   straight: a.xy b.xy
//   disc:     centre.xy radius -
//   arc:      centre.xy radius - | a.xy b.xy
//   ellipse:  centre.xy reach whole | rows of the frame | a.xy b.xy | columns of its inverse
// A list's head: first texel, then counts: straight | emitting ones << 16, discs | emitting ones << 16,
// arcs | emitting ones << 8 | ellipses << 16 | emitting ones << 24. Emitting entries come first of their kind.
// A list without entries has the first texel kExactOpen (nothing in sight but the sky) or kExactDark.
const uint kExactOpen = 0xfffffffeu;
const uint kExactDark = 0xffffffffu;
const uint kExactTooLong = 0x7fffffffu;  // a list has more entries than its head can count

// Surfaces that reflect (docs/methods/bounces.md). A piece is cut into elements along its course u from 0 to 1, which is the
// way from a to b or the angle in its own frame. Its texel: first element, how many (negative: of equal size, around a whole
// curve), angle where it starts, angle that it covers (0: straight).
// An element's texels: integral of radiance from u = 0 to its start, u there | mean radiance, size in u |
// change of radiance across it, unused.
// A node's texels: place, outward normal | element, its extent as a vector, unused.
// A material's texels: emission at u = 0 | its change up to u = 1 | half the albedo.
const int kExactElementTexels = 3;
const int kExactMaterialTexels = 3;
const int kExactNodeRow = 1024;       // nodes in a row of the images that they are solved in
// Units of the reflection, which needs no lists.
const int kExactMaterialsUnit = 5;
const int kExactNodeValuesUnit = 6;   // RGBA32F: irradiance by element
const int kExactNodeLightsUnit = 7;  // RGBA32F: irradiance that lights without a size give, by element
const int kExactElementsStorage = 0;
const int kExactChangeStorage = 1;    // uints: most that an element changed by, most that one shines with, as bits of floats

struct ExactParams {
    ivec2 origin;
    ivec2 extent;
    ivec2 canvas;
    ivec2 border;        // grid pixels left of and above the view
    ivec2 tiles;         // of the lists that are made or read
    ivec2 parent_tiles;  // of the lists that they are made from
    int first_row;       // first row of pixels of this band
    int tile_px;
    int parent_ratio;    // tiles a parent tile is across; 0: one list for all
    int sectors;
    int largest_cell;    // px: larger cells are always split
    int told;            // where lists tell what they took
    float tan_half;      // tangent of half a sector
    int sky_kind;        // 0: none, 1: constant, 2: nodes
    vec4 sky;
    int sky_nodes;       // around the circle
    int cell;            // px
    int level;
    int first_point;     // of the level, in the list of points
    int tile_points;     // of the level, room for each tile
    int first_count;     // of the level, in the counters
    int capacity;        // texels of entries
    int continues;       // goes on where the dispatch before ended
    float light_scale;   // of what lights without a size give surfaces; 0: there are none
    float tolerance;     // of the interpolation, relative
    int kink_cell;       // cells larger than this are split where what is seen differs
    float floor_share;   // of the mean radiance, added to what the tolerance is relative to
    int ask_first;       // asks for the corners of the largest cells, and no more
    int strict_dark;     // split where some corners are dark and others are not
    int first_ask;       // of the level, in the words of what is asked for
    int pad1;
    ivec4 root_counts;   // of the one list of all pieces, by kind
    ivec4 root_lights;   // the emitting ones among them
    int wide;            // the lists are for making further lists: heads of two texels
    int jobs;            // of surfaces
    ivec2 list_origin;   // of the lists' first tile, px
    ivec4 window;        // first and end of the tiles, of the band, whose pixels are asked for
    ivec2 fill_first;    // first of those pixels, of the band
    int fill_row;        // where their rows begin in the image
    int pad7;
    ivec2 fill_size;     // how many of them, along x and y
    ivec2 pad8;
    vec4 most;           // no pixel has more light, by colour
};

#ifdef __cplusplus
}
#endif
#endif
