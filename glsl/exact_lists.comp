// Reads lists of pieces of larger tiles (or one list of all); writes those of smaller tiles: for each tile and sector of
// directions, the pieces of outline that some point of the tile may see in some direction of the sector, nearer than
// what surely hides the rest. One thread is one tile and sector.
#version 430 core
#include "exact.h"
#include "lib/pick.glsl"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kExactEntriesUnit) uniform samplerBuffer entries;
layout(binding = kExactLightsUnit) uniform samplerBuffer lights;
layout(binding = kExactSectorsUnit) uniform samplerBuffer sectors;
layout(std430, binding = kExactHeadsStorage) writeonly buffer Heads { uvec4 out_heads[]; };
layout(std430, binding = kExactEntriesStorage) writeonly buffer Entries { vec4 out_entries[]; };
layout(std430, binding = kExactLightsStorage) writeonly buffer Lights { vec4 out_lights[]; };
layout(std430, binding = kExactCountersStorage) buffer Counters { uint counters[]; };

const int kArcs = 1;      // the parent's lists hold arcs
const int kEllipses = 1;  // and ellipses
const float kFar = 1e30;
const float kSlack = 1e-3;  // px: what hides must hide by this much

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Seen from the tile's centre: the region that rays of the sector from anywhere in the tile can reach lies left of d0,
// right of d1, and not behind; `reach` is how far the tile itself extends across each of the three lines.
vec2 d0, d1, axis;
vec3 reach;
float half_tile;

// The sector in eight bins, each between its own two directions: what fills a bin for all of the tile hides all beyond.
vec4 low_x[2], low_y[2], low_reach[2], high_x[2], high_y[2], high_reach[2];
vec4 hidden[2];  // depth beyond which nothing in the bin can be seen

void begin_bins() {
    for (int half_index = 0; half_index < 2; ++half_index) {
        vec4 k = params.tan_half * (vec4(0.0, 1.0, 2.0, 3.0) + 4.0 * float(half_index) - 4.0) * 0.25;
        vec4 x = axis.x - axis.y * k;
        vec4 y = axis.y + axis.x * k;
        vec4 size = inversesqrt(x * x + y * y);
        low_x[half_index] = x * size;
        low_y[half_index] = y * size;
        low_reach[half_index] = half_tile * (abs(x) + abs(y)) * size + kSlack;
        k += params.tan_half * 0.25;
        x = axis.x - axis.y * k;
        y = axis.y + axis.x * k;
        size = inversesqrt(x * x + y * y);
        high_x[half_index] = x * size;
        high_y[half_index] = y * size;
        high_reach[half_index] = half_tile * (abs(x) + abs(y)) * size + kSlack;
        hidden[half_index] = vec4(kFar);
    }
}

// Something reaches from b (towards smaller angles) to a, not deeper than `high`, and turns its front to all of the tile.
void hide_behind(vec2 a, vec2 b, float high) {
    for (int i = 0; i < 2; ++i) {
        vec4 before = low_x[i] * b.y - low_y[i] * b.x + low_reach[i];
        vec4 after = high_y[i] * a.x - high_x[i] * a.y + high_reach[i];
        hidden[i] = pick(hidden[i], min(hidden[i], vec4(high)), lessThan(max(before, after), vec4(0.0)));
    }
}

// Whether something between a and b, grown by `radius`, may be seen in a bin at a depth of `low` or more.
bool may_be_seen(vec2 a, vec2 b, float radius, float low) {
    bool seen = false;
    for (int i = 0; i < 2; ++i) {
        vec4 left = max(low_x[i] * b.y - low_y[i] * b.x, low_x[i] * a.y - low_y[i] * a.x) + low_reach[i] + radius;
        vec4 right = max(high_y[i] * a.x - high_x[i] * a.y, high_y[i] * b.x - high_x[i] * b.y) + high_reach[i] + radius;
        vec4 shut = vec4(lessThan(min(left, right), vec4(0.0))) + vec4(lessThan(hidden[i], vec4(low)));
        seen = seen || any(equal(shut, vec4(0.0)));
    }
    return seen;
}

vec3 inside_of(vec2 q) { return vec3(cross2(d0, q), cross2(q, d1), dot(axis, q)) + reach; }

// Depths along the axis of the part of a straight piece in the region; false: no part of it, or it shows its back.
bool straight_depths(vec2 a, vec2 b, out float low, out float high, out bool hides) {
    vec2 e = b - a;
    float rise = cross2(a, e);
    float tilt = half_tile * (abs(e.x) + abs(e.y));
    vec3 fa = inside_of(a);
    vec3 fb = inside_of(b);
    vec3 cut = fa / (fa - fb);
    vec3 from = pick(vec3(0.0), cut, lessThan(fa, vec3(0.0)));
    vec3 to = pick(vec3(1.0), cut, lessThan(fb, vec3(0.0)));
    float t0 = max(max(from.x, from.y), max(from.z, 0.0));
    float t1 = min(min(to.x, to.y), min(to.z, 1.0));
    bvec3 out_of = lessThan(max(fa, fb), vec3(0.0));
    float da = dot(axis, a + e * t0);
    float db = dot(axis, a + e * t1);
    low = min(da, db) - kSlack;
    high = max(da, db) + kSlack;
    hides = rise + tilt < 0.0;
    return !any(out_of) && t0 <= t1 && rise - tilt < 0.0;
}

bool round_depths(vec2 centre, float radius, out float low, out float high, out bool hides) {
    vec3 f = inside_of(centre);
    float depth = dot(axis, centre);
    low = depth - radius - kSlack;
    high = depth + radius + kSlack;
    hides = depth - reach.z > 0.0;
    return f.x + radius >= 0.0 && f.y + radius >= 0.0 && f.z + radius >= 0.0;
}

// An arc shows nothing to the tile where all of its outward normals turn away from it.
bool arc_faces(vec2 from, float radius, vec4 ends, vec2 centre) {
    vec2 ra = ends.xy - centre - from;
    vec2 rb = ends.zw - centre - from;
    float most = max(dot(ra, -from), dot(rb, -from));
    if (cross2(ra, -from) > 0.0 && cross2(-from, rb) > 0.0) most = radius * length(from);
    return most + radius * half_tile * 1.4143 > radius * radius;
}

void write_head(int list, uint first, uvec4 counts, uvec4 emitting) {
    if (params.wide != 0) {
        out_heads[2 * list] = counts;
        out_heads[2 * list + 1] = uvec4(first, emitting.x | (emitting.y << 16), emitting.z | (emitting.w << 16), 0u);
    } else {
        out_heads[list] = uvec4(first, counts.x | (emitting.x << 16), counts.y | (emitting.y << 16),
                                counts.z | (emitting.z << 8) | (counts.w << 16) | (emitting.w << 24));
    }
}

void main() {
    ivec2 at = params.origin + ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.extent.x || at.y >= params.extent.y) return;
    int row = at.y / params.sectors;
    int sector = at.y - row * params.sectors;
    int list = (row * params.tiles.x + at.x) * params.sectors + sector;
    int parent = params.parent_ratio == 0 ? 0
        : ((row / params.parent_ratio) * params.parent_tiles.x + at.x / params.parent_ratio) * params.sectors + sector;

    // The points of a tile are centres of pixels, the next column and row among them.
    half_tile = 0.5 * float(params.tile_px);
    vec2 centre = vec2(at.x, row) * float(params.tile_px) + half_tile + 0.5 + vec2(params.list_origin);
    axis = texelFetch(sectors, sector).xy;
    vec2 side = vec2(-axis.y, axis.x) * params.tan_half;
    d0 = normalize(axis - side);
    d1 = normalize(axis + side);
    reach = half_tile * vec3(abs(d0.x) + abs(d0.y), abs(d1.x) + abs(d1.y), abs(axis.x) + abs(axis.y)) + kSlack;

    uvec4 counts = uvec4(params.root_counts);
    uvec4 lights_of = uvec4(params.root_lights);
    uint first = 0u;
    bool dark = false;
    if (params.parent_ratio != 0) {
        counts = texelFetch(heads, 2 * parent);
        uvec4 rest = texelFetch(heads, 2 * parent + 1);
        first = rest.x;
        dark = first == kExactDark;  // and so is all within
        lights_of = uvec4(rest.y & 0xffffu, rest.y >> 16, rest.z & 0xffffu, rest.z >> 16);
    }
    uint straights = counts.x, straight_lights = lights_of.x;
    uint discs = counts.y, disc_lights = lights_of.y;
    uint arcs = counts.z, arc_lights = lights_of.z;
    uint ellipses = counts.w, ellipse_lights = lights_of.w;
    uint first_disc = first + straights;
    uint first_arc = first_disc + discs;
    uint first_ellipse = first_arc + 2u * arcs;

    // First what hides, then what may be seen of the rest, and where lights begin and end.
    begin_bins();
    float low, high;
    bool hides;
    for (uint i = 0u; i < straights; ++i) {
        vec4 e = texelFetch(entries, int(first + i));
        vec2 a = e.xy - centre;
        vec2 b = e.zw - centre;
        if (straight_depths(a, b, low, high, hides) && hides) hide_behind(a, b, high);
    }
    for (uint i = 0u; i < discs; ++i) {
        vec4 e = texelFetch(entries, int(first_disc + i));
        vec2 c = e.xy - centre;
        // A chord across the axis hides as much as a wall.
        vec2 half_chord = vec2(-axis.y, axis.x) * e.z;
        if (round_depths(c, e.z, low, high, hides) && hides) hide_behind(c + half_chord, c - half_chord, high - e.z);
    }
    bool sky = params.sky_kind != 0 && !dark && any(equal(max(hidden[0], hidden[1]), vec4(kFar)));
    float light_high = -kFar;
    uint room = 0u;
    for (uint i = 0u; i < straights; ++i) {
        vec4 e = texelFetch(entries, int(first + i));
        vec2 a = e.xy - centre;
        vec2 b = e.zw - centre;
        if (straight_depths(a, b, low, high, hides) && may_be_seen(a, b, 0.0, low)) {
            ++room;
            if (i < straight_lights) light_high = max(light_high, high);
        }
    }
    for (uint i = 0u; i < discs; ++i) {
        vec4 e = texelFetch(entries, int(first_disc + i));
        vec2 c = e.xy - centre;
        if (round_depths(c, e.z, low, high, hides) && may_be_seen(c, c, e.z, low)) {
            ++room;
            if (i < disc_lights) light_high = max(light_high, high);
        }
    }
    if (kArcs != 0) for (uint i = 0u; i < arcs; ++i) {
        vec4 e = texelFetch(entries, int(first_arc + 2u * i));
        vec4 ends = texelFetch(entries, int(first_arc + 2u * i + 1u));
        vec2 c = e.xy - centre;
        if (round_depths(c, e.z, low, high, hides) && arc_faces(c, e.z, ends, centre) && may_be_seen(c, c, e.z, low)) {
            room += 2u;
            if (i < arc_lights) light_high = max(light_high, high);
        }
    }
    if (kEllipses != 0) for (uint i = 0u; i < ellipses; ++i) {
        vec4 e = texelFetch(entries, int(first_ellipse + 4u * i));
        vec2 c = e.xy - centre;
        if (round_depths(c, e.z, low, high, hides) && may_be_seen(c, c, e.z, low)) {
            room += 4u;
            if (i < ellipse_lights) light_high = max(light_high, high);
        }
    }

    // Beyond the last light nothing matters, unless there is a sky, which what lies beyond may hide.
    bool lit = light_high > -kFar;
    float limit = params.sky_kind != 0 ? kFar : light_high;
    if (!lit && !sky) room = 0u;
    uint begin = 0u;
    if (room > 0u) begin = atomicAdd(counters[kExactCountEntries], room);
    bool fits = begin + room <= uint(params.capacity);
    if (room == 0u || !fits) {
        write_head(list, sky ? kExactOpen : kExactDark, uvec4(0u), uvec4(0u));
        return;
    }

    uint to = begin;
    uvec4 kept = uvec4(0u);
    uvec4 kept_lights = uvec4(0u);
    for (uint i = 0u; i < straights; ++i) {
        vec4 e = texelFetch(entries, int(first + i));
        if (straight_depths(e.xy - centre, e.zw - centre, low, high, hides) && low <= limit &&
            may_be_seen(e.xy - centre, e.zw - centre, 0.0, low)) {
            out_entries[to] = e;
            out_lights[to] = texelFetch(lights, int(first + i));
            ++to;
            ++kept.x;
            if (i < straight_lights) ++kept_lights.x;
        }
    }
    for (uint i = 0u; i < discs; ++i) {
        vec4 e = texelFetch(entries, int(first_disc + i));
        if (round_depths(e.xy - centre, e.z, low, high, hides) && low <= limit &&
            may_be_seen(e.xy - centre, e.xy - centre, e.z, low)) {
            out_entries[to] = e;
            out_lights[to] = texelFetch(lights, int(first_disc + i));
            ++to;
            ++kept.y;
            if (i < disc_lights) ++kept_lights.y;
        }
    }
    if (kArcs != 0) for (uint i = 0u; i < arcs; ++i) {
        uint place = first_arc + 2u * i;
        vec4 e = texelFetch(entries, int(place));
        vec4 ends = texelFetch(entries, int(place + 1u));
        if (round_depths(e.xy - centre, e.z, low, high, hides) && low <= limit &&
            may_be_seen(e.xy - centre, e.xy - centre, e.z, low) && arc_faces(e.xy - centre, e.z, ends, centre)) {
            out_entries[to] = e;
            out_entries[to + 1u] = ends;
            out_lights[to] = texelFetch(lights, int(place));
            to += 2u;
            ++kept.z;
            if (i < arc_lights) ++kept_lights.z;
        }
    }
    if (kEllipses != 0) for (uint i = 0u; i < ellipses; ++i) {
        uint place = first_ellipse + 4u * i;
        vec4 e = texelFetch(entries, int(place));
        if (round_depths(e.xy - centre, e.z, low, high, hides) && low <= limit &&
            may_be_seen(e.xy - centre, e.xy - centre, e.z, low)) {
            for (uint k = 0u; k < 4u; ++k) out_entries[to + k] = texelFetch(entries, int(place + k));
            out_lights[to] = texelFetch(lights, int(place));
            to += 4u;
            ++kept.w;
            if (i < ellipse_lights) ++kept_lights.w;
        }
    }
    uint total = kept.x + kept.y + kept.z + kept.w;
    write_head(list, total > 0u ? begin : (sky ? kExactOpen : kExactDark), kept, kept_lights);
    // Each step of the walk asks every entry; each entry starts and ends at most one interval.
    bool fits_head = params.wide != 0 ? all(lessThan(kept_lights, uvec4(65536u)))
                                      : kept.x < 65536u && kept.y < 65536u && kept.z < 256u && kept.w < 256u && total < 20000u;
    atomicMax(counters[kExactCountWork], !fits_head ? kExactTooLong : params.wide != 0 ? 0u : (2u * total + 3u) * (total + 13u));
}
