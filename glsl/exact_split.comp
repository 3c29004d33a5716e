// Decides for each cell of a level whether its four corners tell all of it: it is free of shapes, the same edges bound what
// its corners see (then no shadow's edge crosses it: docs/methods/exact-gpu.md), and the light bends little enough. A cell
// that fails is split, and asks for the points that its four parts lack. One thread is one cell; of the smaller ones, one of those whose
// larger cell was split.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kExactValueImage, rgba32f) readonly uniform image2D value_image;
layout(binding = kExactSlopeXImage, rgba32f) readonly uniform image2D slope_x_image;
layout(binding = kExactSlopeYImage, rgba32f) readonly uniform image2D slope_y_image;
layout(binding = kExactLeafImage, r32ui) uniform uimage2D leaf_image;
layout(std430, binding = kExactAsksStorage) buffer AskedBits { uint asks[]; };
layout(std430, binding = kExactCellsStorage) writeonly buffer SplitCells { uint split_cells[]; };
layout(std430, binding = kExactCountersStorage) buffer Counters { uint counters[]; };
layout(binding = kExactCellsUnit) uniform usamplerBuffer larger_cells;
layout(binding = kExactSkyUnit) uniform samplerBuffer mean_light;
layout(binding = kExactHeadsUnit) uniform usamplerBuffer heads;

float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }

// A bit of the tile that it is of, a word a row: in which order cells ask shows nowhere.
void ask(ivec2 point) {
    ivec2 tile = min(point / kExactTile, params.tiles - 1);
    ivec2 local = point - tile * kExactTile;
    atomicOr(asks[params.first_ask + (tile.y * params.tiles.x + tile.x) * kExactTileRows + local.y], 1u << local.x);
}

void main() {
    ivec2 cell = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (cell.x >= params.extent.x || cell.y >= params.extent.y) return;
    int h = params.cell;
    if (h < kExactCell) {
        int index = cell.y * params.extent.x + cell.x;
        if (index >= 4 * int(counters[kExactCountCells + params.level - 1])) return;
        uint larger = texelFetch(larger_cells, index / 4).r;
        cell = 2 * ivec2(int(larger & 0xffffu), int(larger >> 16)) + ivec2(index & 1, index >> 1 & 1);
    }
    ivec2 corner = cell * h;  // first pixel, of the band
    ivec4 window = params.window * (kExactTile / h);
    if (params.ask_first != 0) {
        // Elsewhere the tiles' corners only, for the mean of the light.
        bool inside = all(greaterThanEqual(cell, window.xy)) && all(lessThanEqual(cell, window.zw));
        bool of_tile = corner % kExactTile == ivec2(0) && all(lessThan(corner, params.tiles * kExactTile));
        if (inside || of_tile) ask(corner);
        return;
    }
    if (any(lessThan(cell, window.xy)) || any(greaterThanEqual(cell, window.zw))) return;
    if (h == kExactCell) imageStore(leaf_image, corner, uvec4(h));
    ivec2 pixel = corner + ivec2(0, params.first_row);
    if (pixel.x >= params.canvas.x || pixel.y >= params.canvas.y) return;

    ivec2 middle = min(pixel + h / 2, params.canvas - 1);
    float room = texelFetch(distance_texture, min(middle + params.border, textureSize(distance_texture, 0) - 1), 0).r;
    float clear = 0.7072 * float(h) + 0.01;
    if (room < -clear) return;  // all of it inside a shape

    vec4 v0 = imageLoad(value_image, corner);
    vec4 v1 = imageLoad(value_image, corner + ivec2(h, 0));
    vec4 v2 = imageLoad(value_image, corner + ivec2(0, h));
    vec4 v3 = imageLoad(value_image, corner + ivec2(h, h));
    vec4 x0 = imageLoad(slope_x_image, corner);
    vec4 x1 = imageLoad(slope_x_image, corner + ivec2(h, 0));
    vec4 x2 = imageLoad(slope_x_image, corner + ivec2(0, h));
    vec4 x3 = imageLoad(slope_x_image, corner + ivec2(h, h));
    float b0 = largest(v0.rgb), b1 = largest(v1.rgb), b2 = largest(v2.rgb), b3 = largest(v3.rgb);
    float darkest = min(min(b0, b1), min(b2, b3));
    float brightest = max(max(b0, b1), max(b2, b3));
    float relative_to = params.tolerance * (0.25 * (b0 + b1 + b2 + b3) + params.floor_share * texelFetch(mean_light, 0).r);
    bool same = v0.a == v1.a && v0.a == v2.a && v0.a == v3.a;

    bool split = room < clear || h > params.largest_cell;
    // The interpolation is exact for quadratics; what it leaves out is at most 0.05 h^3 times the third derivative.
    float third = max(max(x0.a, x1.a), max(x2.a, x3.a));
    split = split || 0.05 * float(h * h * h) * third > relative_to;
    if (!same) {
        split = split || h > params.kink_cell || (params.strict_dark != 0 && darkest <= 0.0);
        // A shadow's edge bends the light by at most the change of its slope across the cell.
        vec4 y0 = imageLoad(slope_y_image, corner);
        vec4 y1 = imageLoad(slope_y_image, corner + ivec2(h, 0));
        vec4 y2 = imageLoad(slope_y_image, corner + ivec2(0, h));
        vec4 y3 = imageLoad(slope_y_image, corner + ivec2(h, h));
        vec3 dx = max(abs(x1.rgb - x0.rgb), abs(x3.rgb - x2.rgb));
        vec3 dy = max(abs(y2.rgb - y0.rgb), abs(y3.rgb - y1.rgb));
        float bend = max(largest(dx), largest(dy));
        split = split || 0.125 * float(h) * bend > relative_to;
        // One narrower than the cell shows in the values: they differ from what the slopes foretell.
        float reach = 0.5 * float(h);
        vec3 off = max(max(abs(v1.rgb - v0.rgb - reach * (x0.rgb + x1.rgb)), abs(v3.rgb - v2.rgb - reach * (x2.rgb + x3.rgb))),
                       max(abs(v2.rgb - v0.rgb - reach * (y0.rgb + y2.rgb)), abs(v3.rgb - v1.rgb - reach * (y1.rgb + y3.rgb))));
        split = split || 0.5 * largest(off) > relative_to;
    }
    // All dark: then a beam through a gap narrower than the cell may fall between the corners. Not where no point of the tile
    // can see any light.
    if (brightest <= 0.0) {
        ivec2 tile = corner / kExactTile;
        int list = (tile.y * params.tiles.x + tile.x) * params.sectors;
        for (int s = split ? params.sectors : 0; s < params.sectors; ++s) {
            if (texelFetch(heads, list + s).x != kExactDark) {
                split = true;
                break;
            }
        }
    }
    if (!split) return;

    int half_cell = h / 2;
    split_cells[atomicAdd(counters[kExactCountCells + params.level], 1u)] = uint(cell.x) | uint(cell.y) << 16;
    // Each of its parts is whole until it is split in its turn.
    imageStore(leaf_image, corner, uvec4(half_cell));
    imageStore(leaf_image, corner + ivec2(half_cell, 0), uvec4(half_cell));
    imageStore(leaf_image, corner + ivec2(0, half_cell), uvec4(half_cell));
    imageStore(leaf_image, corner + ivec2(half_cell), uvec4(half_cell));
    ask(corner + ivec2(half_cell, 0));
    ask(corner + ivec2(0, half_cell));
    ask(corner + ivec2(half_cell));
    if (half_cell == 1) return;  // pixels: those of the next cell are asked for by that cell, if at all
    ask(corner + ivec2(h, half_cell));
    ask(corner + ivec2(half_cell, h));
}
