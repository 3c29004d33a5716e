// The packed scene: what core/plan/pack.cpp writes and lib/scene.glsl reads, in pixel units of the view
// (origin at the view's top left corner, so that numbers stay small wherever the view lies).
#ifndef PENUMBRA_GLSL_SCENE_RECORDS_H
#define PENUMBRA_GLSL_SCENE_RECORDS_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

// Shape types, in the order of the Geometry variant.
const int kShapeCircle = 0;
const int kShapeEllipse = 1;
const int kShapeRect = 2;
const int kShapeLine = 3;
const int kShapePolyline = 4;
const int kShapePolygon = 5;
const int kShapeBitmap = 6;

// A shape is kShapeTexels RGBA32F texels of the buffer texture `shape_records`:
//   0: type, grow, first edge, edge count
//      grow: how much the marched outline is fattened (px) so that a stroke thinner than the
//      shortest step still stops every ray; its light is scaled by thickness / fattened thickness
//   1: emission rgb, emission scale (bitmap) or marched light's factor (others)
//   2: circle cx cy r -   ellipse cx cy rx ry   rect cx cy hx hy   line x0 y0 x1 y1
//      polyline, polygon: bounding box x0 y0 x1 y1   bitmap x y w h
//   3: ellipse cos sin - -   rect cos sin corner -   line, polyline: stops of its gradient, first texel of it, half width, -
//      bitmap: first texel, texels across, texels down, alpha threshold
const int kShapeTexels = 4;
// A stroke's gradient stands among the edges: of a polyline, a texel for each of its edges with the shares of the stroke's length at
// which it starts and ends; then the stops, emission rgb and share. A stroke without one has no stops.

// Newton steps of the distance to an ellipse; the plan counts them where loops are bounded.
const int kEllipseIterations = 12;

// Translucent shapes have records as others, behind all of them; their texel 1 holds the extinction per px. More of them:
//   0: first record, how many, iterations of asking each once, unused    1: a box around all of them, cut off at the domain
//   then two texels each: emission rgb per px, unused | the box that it lies in
const int kMediaUnit = 14;  // RGBA32F

// Texture units of the scene's buffer textures, the same in every pass.
const int kShapeRecordsUnit = 0;
const int kEdgesUnit = 1;         // RGBA32F: x0 y0 x1 y1 of an edge
const int kBitmapTexelsUnit = 2;  // RGBA8: sRGB colour, straight alpha
const int kSkySectorsUnit = 3;    // RGBA32F: mean sky radiance over each direction's sector

#ifdef __cplusplus
}
#endif
#endif
