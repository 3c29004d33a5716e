#ifndef PENUMBRA_GLSL_FLOOR_H
#define PENUMBRA_GLSL_FLOOR_H
#include "types.h"
#ifdef __cplusplus
namespace penumbra::glsl {
#endif

// What the floor sends up (docs/methods/floor.md).
const int kFloorGroupX = 64;  // Mesa 22 vectorises along x only
const int kFloorGroupY = 1;
const int kFloorParamsBinding = 0;

// Texture units. One texel stands for all pixels.
const int kFloorRadianceUnit = 6;  // mean radiance
const int kFloorLightsUnit = 7;    // what lights without a size add to it; not read where the floor has relief
const int kFloorMomentXUnit = 8;   // mean of radiance times direction
const int kFloorMomentYUnit = 9;
const int kFloorAlbedoUnit = 10;   // RGBA32F: albedo
const int kFloorNormalUnit = 11;   // RGBA32F: which way the floor faces
const int kFloorTableUnit = 13;    // RGBA32F: two texels a tilt (core/floor/response.h), then alpha, metallic, F0 of what is no metal

const int kFloorImage = 0;

const int kFloorTilts = 128;

struct FloorParams {
    ivec2 origin;
    ivec2 extent;
    ivec2 first_pixel;    // of the image in the radiance
    float radiance_scale; // what the radiance textures must be multiplied with
    int pad0;
};

#ifdef __cplusplus
}
#endif
#endif
