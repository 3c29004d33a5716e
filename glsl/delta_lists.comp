// Reads lists of pieces of larger tiles (or one list of all); writes those of smaller tiles: for each tile and light, the
// pieces of outline that may stand between some point of the tile and the light. One thread is one tile and light.
#version 430 core
#include "delta.h"
#include "lib/pick.glsl"

layout(local_size_x = kDeltaGroupX, local_size_y = kDeltaGroupY) in;
layout(std140, binding = kDeltaParamsBinding) uniform Params { DeltaParams params; };
layout(binding = kDeltaHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kDeltaEntriesUnit) uniform samplerBuffer entries;
layout(binding = kDeltaLightsUnit) uniform samplerBuffer lights;
layout(std430, binding = kDeltaHeadsStorage) writeonly buffer Heads { uvec4 out_heads[]; };
layout(std430, binding = kDeltaEntriesStorage) writeonly buffer Entries { vec4 out_entries[]; };
layout(std430, binding = kDeltaCountersStorage) buffer Counters { uint counters[]; };

const float kSlack = 1e-2;  // px

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Seen from the tile's centre with the light ahead: what lies between tile and light is within `wide` to either side and
// `deep` behind, and within the lines from the tile's sides to the light, `away` ahead (0: they are parallel).
vec2 ahead;
float wide, deep, away, half_tile, taper;

// How far inside of the four sides and the back, px.
void inside_of(vec2 q, out vec4 sides, out float front) {
    float s = cross2(ahead, q);
    float a = dot(ahead, q);
    float room = away > 0.0 ? wide * (away - a) : 0.0;
    float lean = away > 0.0 ? s * (away - deep) : 0.0;
    sides = vec4(wide - s, wide + s, (room - lean) * taper, (room + lean) * taper) + kSlack;
    if (away <= 0.0) sides.zw = sides.xy;
    front = a + deep + kSlack;
}

bool straight_between(vec2 a, vec2 b, out bool fills) {
    vec2 along = b - a;
    float rise = cross2(a, along);
    float tilt = half_tile * (abs(along.x) + abs(along.y));
    vec4 fa, fb;
    float ba, bb;
    inside_of(a, fa, ba);
    inside_of(b, fb, bb);
    vec4 cut = fa / (fa - fb);
    vec4 from = pick(vec4(0.0), cut, lessThan(fa, vec4(0.0)));
    vec4 to = pick(vec4(1.0), cut, lessThan(fb, vec4(0.0)));
    float from_back = ba < 0.0 ? ba / (ba - bb) : 0.0;
    float to_back = bb < 0.0 ? ba / (ba - bb) : 1.0;
    float t0 = max(max(max(from.x, from.y), max(from.z, from.w)), from_back);
    float t1 = min(min(min(to.x, to.y), min(to.z, to.w)), to_back);
    bool out_of = any(lessThan(max(fa, fb), vec4(0.0))) || max(ba, bb) < 0.0;
    // All of the tile before it, the light behind it, and its ends beyond both lines to the light.
    float behind = away > 0.0 ? cross2(a - ahead * away, along) : -cross2(ahead, along);
    // (Outside of both is beyond the light.)
    bool across = (max(fa.z, fb.w) < -kSlack && min(fa.w, fb.z) > 0.0) || (max(fa.w, fb.z) < -kSlack && min(fa.z, fb.w) > 0.0);
    fills = across && rise + tilt < 0.0 && behind > 2.0 * kSlack * (abs(along.x) + abs(along.y));
    return !out_of && t0 <= t1 && rise - tilt < 0.0;
}

bool round_between(vec2 centre, float radius) {
    vec4 f;
    float back;
    inside_of(centre, f, back);
    return all(greaterThanEqual(f + radius, vec4(0.0))) && back + radius >= 0.0;
}

void main() {
    ivec2 at = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.extent.x || at.y >= params.extent.y) return;
    int row = at.y / params.lights;
    int light = at.y - row * params.lights;
    int list = (row * params.tiles.x + at.x) * params.lights + light;
    half_tile = 0.5 * float(params.tile_px) + 0.5;
    vec2 centre = vec2(at.x, row) * float(params.tile_px) + 0.5 * float(params.tile_px) + 0.5 + vec2(params.list_origin);

    vec4 head = texelFetch(lights, kDeltaLightTexels * light);
    int kind = int(head.z) & 3;
    bool raised = (int(head.z) & kDeltaRaised) != 0;
    vec2 way = kind == kDeltaDirectional ? head.xy : head.xy - centre;
    float distance_to = length(way);
    ahead = distance_to > 0.0 ? way / distance_to : vec2(1.0, 0.0);
    wide = half_tile * (abs(ahead.x) + abs(ahead.y));
    deep = wide;
    // A light in the tile, or near it, may lie in any direction: then only what is not far counts.
    bool within = kind != kDeltaDirectional && distance_to < 1.01 * deep + 1.0;
    away = kind == kDeltaDirectional || within ? 0.0 : distance_to;
    taper = away > 0.0 ? inversesqrt(wide * wide + (away - deep) * (away - deep)) : 1.0;

    bool dark = false;
    if (kind == kDeltaSpot) {
        // No point of the tile lies in the beam.
        vec4 spot = texelFetch(lights, kDeltaLightTexels * light + 2);
        float tilt = raised ? texelFetch(lights, kDeltaLightTexels * light + 1).w : 0.0;
        vec3 axis = vec3(spot.xy * cos(tilt), -sin(tilt));
        vec3 from = vec3(-way, raised ? -head.w : 0.0);
        float reach = 1.4143 * half_tile;
        float off = atan(length(cross(axis, from)), dot(axis, from));
        dark = length(from) > reach && off - asin(min(reach / length(from), 1.0)) > spot.w + 1e-3;
    }

    uvec4 counts = uvec4(params.root_counts);
    uint first = 0u;
    if (params.parent_ratio != 0) {
        int parent = ((row / params.parent_ratio) * params.parent_tiles.x + at.x / params.parent_ratio) * params.lights + light;
        uvec4 parent_head = texelFetch(heads, parent);
        first = parent_head.x;
        dark = dark || first == kDeltaDark;
        counts = uvec4(parent_head.y & 0xffffu, parent_head.y >> 16, parent_head.z & 0xffffu, parent_head.z >> 16);
        if (first >= kDeltaOpen) counts = uvec4(0u);
    }
    uint first_disc = first + counts.x;
    uint first_arc = first_disc + counts.y;
    uint first_ellipse = first_arc + 2u * counts.z;

    uint room = 0u;
    bool fills;
    for (uint i = 0u; i < counts.x; ++i) {
        vec4 e = texelFetch(entries, int(first + i));
        if (straight_between(e.xy - centre, e.zw - centre, fills)) ++room;
        if (fills && !within) dark = true;
    }
    for (uint i = 0u; i < counts.y; ++i) {
        vec4 e = texelFetch(entries, int(first_disc + i));
        if (round_between(e.xy - centre, e.z)) ++room;
    }
    for (uint i = 0u; i < counts.z; ++i) {
        vec4 e = texelFetch(entries, int(first_arc + 2u * i));
        if (round_between(e.xy - centre, e.z)) room += 2u;
    }
    for (uint i = 0u; i < counts.w; ++i) {
        vec4 e = texelFetch(entries, int(first_ellipse + 4u * i));
        if (round_between(e.xy - centre, e.z)) room += 4u;
    }
    if (dark) room = 0u;
    uint begin = 0u;
    if (room > 0u) begin = atomicAdd(counters[kDeltaCountEntries], room);
    if (room == 0u || begin + room > uint(params.capacity)) {
        out_heads[list] = uvec4(dark ? kDeltaDark : kDeltaOpen, 0u, 0u, 0u);
        return;
    }
    uint to = begin;
    uvec4 kept = uvec4(0u);
    for (uint i = 0u; i < counts.x; ++i) {
        vec4 e = texelFetch(entries, int(first + i));
        if (straight_between(e.xy - centre, e.zw - centre, fills)) {
            out_entries[to] = e;
            ++to;
            ++kept.x;
        }
    }
    for (uint i = 0u; i < counts.y; ++i) {
        vec4 e = texelFetch(entries, int(first_disc + i));
        if (round_between(e.xy - centre, e.z)) {
            out_entries[to] = e;
            ++to;
            ++kept.y;
        }
    }
    for (uint i = 0u; i < counts.z; ++i) {
        int place = int(first_arc + 2u * i);
        vec4 e = texelFetch(entries, place);
        if (round_between(e.xy - centre, e.z)) {
            out_entries[to] = e;
            out_entries[to + 1u] = texelFetch(entries, place + 1);
            to += 2u;
            ++kept.z;
        }
    }
    for (uint i = 0u; i < counts.w; ++i) {
        int place = int(first_ellipse + 4u * i);
        vec4 e = texelFetch(entries, place);
        if (round_between(e.xy - centre, e.z)) {
            for (int k = 0; k < 4; ++k) out_entries[to + uint(k)] = texelFetch(entries, place + k);
            to += 4u;
            ++kept.w;
        }
    }
    out_heads[list] = uvec4(begin, kept.x | (kept.y << 16), kept.z | (kept.w << 16), 0u);
    bool countable = all(lessThan(kept, uvec4(65536u)));
    atomicMax(counters[kDeltaCountMost], countable ? kept.x + kept.y + kept.z + kept.w : kDeltaTooLong);
}
