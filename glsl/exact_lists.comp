// Reads lists of pieces of larger tiles (or one list of all); writes those of smaller tiles: for each tile and sector of
// directions, the pieces of outline that some point of the tile may see in some direction of the sector, nearer than
// what surely hides the rest. One thread is one tile and sector; with kListLanes, several share the pieces that these ask.
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
layout(std430, binding = kExactToldStorage) buffer ToldCounters { uint told[]; };

const int kArcs = 1;      // the parent's lists hold arcs
const int kEllipses = 1;  // and ellipses
const int kListLanes = 1;  // threads, neighbours, that share a list: more on a GPU
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

// The pieces that lists are made from: of which kinds, where, and this thread's part of each kind.
uvec4 counts, lights_of, first_of, part_from, part_to;

// Whether a piece may be seen, no deeper than `limit`; and how deep it reaches.
bool keeps_straight(uint i, vec2 centre, float limit, out vec4 e, out float high) {
    float low;
    bool hides;
    e = texelFetch(entries, int(first_of.x + i));
    vec2 a = e.xy - centre;
    vec2 b = e.zw - centre;
    return straight_depths(a, b, low, high, hides) && low <= limit && may_be_seen(a, b, 0.0, low);
}

bool keeps_round(uint place, vec2 centre, float limit, out vec4 e, out float high) {
    float low;
    bool hides;
    e = texelFetch(entries, int(place));
    vec2 c = e.xy - centre;
    return round_depths(c, e.z, low, high, hides) && low <= limit && may_be_seen(c, c, e.z, low);
}

bool keeps_arc(uint place, vec2 centre, float limit, out vec4 e, out vec4 ends, out float high) {
    bool kept = keeps_round(place, centre, limit, e, high);
    ends = texelFetch(entries, int(place + 1u));
    return kept && arc_faces(e.xy - centre, e.z, ends, centre);
}

// How many of each kind are kept, and how deep the lights among them reach.
uvec4 count_kept(vec2 centre, float limit, out uvec4 emitting, out float light_high) {
    uvec4 kept = uvec4(0u);
    emitting = uvec4(0u);
    light_high = -kFar;
    vec4 e, ends;
    float high;
    for (uint i = part_from.x; i < part_to.x; ++i) {
        if (keeps_straight(i, centre, limit, e, high)) {
            ++kept.x;
            if (i < lights_of.x) {
                ++emitting.x;
                light_high = max(light_high, high);
            }
        }
    }
    for (uint i = part_from.y; i < part_to.y; ++i) {
        if (keeps_round(first_of.y + i, centre, limit, e, high)) {
            ++kept.y;
            if (i < lights_of.y) {
                ++emitting.y;
                light_high = max(light_high, high);
            }
        }
    }
    if (kArcs != 0) for (uint i = part_from.z; i < part_to.z; ++i) {
        if (keeps_arc(first_of.z + 2u * i, centre, limit, e, ends, high)) {
            ++kept.z;
            if (i < lights_of.z) {
                ++emitting.z;
                light_high = max(light_high, high);
            }
        }
    }
    if (kEllipses != 0) for (uint i = part_from.w; i < part_to.w; ++i) {
        if (keeps_round(first_of.w + 4u * i, centre, limit, e, high)) {
            ++kept.w;
            if (i < lights_of.w) {
                ++emitting.w;
                light_high = max(light_high, high);
            }
        }
    }
    return kept;
}

shared vec4 lane_low[kExactGroupX], lane_high[kExactGroupX];
shared uvec4 lane_kept[kExactGroupX], lane_lights[kExactGroupX];
shared float lane_light_high[kExactGroupX];
shared uint list_begin[kExactGroupX];

// What any lane of the list knows to be hidden.
void share_hidden(int of_list, int lane) {
    lane_low[of_list + lane] = hidden[0];
    lane_high[of_list + lane] = hidden[1];
    barrier();
    for (int i = 0; i < kListLanes; ++i) {
        hidden[0] = min(hidden[0], lane_low[of_list + i]);
        hidden[1] = min(hidden[1], lane_high[of_list + i]);
    }
}

// Sums over the lanes of a list, and what those before this one keep.
void share_kept(int of_list, int lane, inout uvec4 kept, inout uvec4 emitting, inout float light_high, out uvec4 before) {
    barrier();
    lane_kept[of_list + lane] = kept;
    lane_lights[of_list + lane] = emitting;
    lane_light_high[of_list + lane] = light_high;
    barrier();
    kept = uvec4(0u);
    emitting = uvec4(0u);
    before = uvec4(0u);
    for (int i = 0; i < kListLanes; ++i) {
        if (i < lane) before += lane_kept[of_list + i];
        kept += lane_kept[of_list + i];
        emitting += lane_lights[of_list + i];
        light_high = max(light_high, lane_light_high[of_list + i]);
    }
}

void main() {
    ivec2 at = params.origin + ivec2(int(gl_GlobalInvocationID.x) / kListLanes, int(gl_GlobalInvocationID.y));
    int lane = int(gl_LocalInvocationID.x) % kListLanes;
    int of_list = int(gl_LocalInvocationID.x) - lane;
    bool outside = at.x >= params.extent.x || at.y >= params.extent.y;
    if (kListLanes == 1 && outside) return;
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

    counts = uvec4(params.root_counts);
    lights_of = uvec4(params.root_lights);
    uint first = 0u;
    bool dark = false;
    if (params.parent_ratio != 0) {
        counts = texelFetch(heads, 2 * parent);
        uvec4 rest = texelFetch(heads, 2 * parent + 1);
        first = rest.x;
        dark = first == kExactDark;  // and so is all within
        lights_of = uvec4(rest.y & 0xffffu, rest.y >> 16, rest.z & 0xffffu, rest.z >> 16);
    }
    if (outside) counts = uvec4(0u);
    first_of = uvec4(first, first + counts.x, first + counts.x + counts.y, first + counts.x + counts.y + 2u * counts.z);
    part_from = uvec4(0u);
    part_to = counts;
    if (kListLanes > 1) {
        uvec4 share = (counts + uint(kListLanes - 1)) / uint(kListLanes);
        part_from = min(share * uint(lane), counts);
        part_to = min(part_from + share, counts);
    }

    // First what hides, then what may be seen of the rest, and where lights begin and end.
    begin_bins();
    float low, high;
    bool hides;
    for (uint i = part_from.x; i < part_to.x; ++i) {
        vec4 e = texelFetch(entries, int(first_of.x + i));
        vec2 a = e.xy - centre;
        vec2 b = e.zw - centre;
        if (straight_depths(a, b, low, high, hides) && hides) hide_behind(a, b, high);
    }
    for (uint i = part_from.y; i < part_to.y; ++i) {
        vec4 e = texelFetch(entries, int(first_of.y + i));
        vec2 c = e.xy - centre;
        // A chord across the axis hides as much as a wall.
        vec2 half_chord = vec2(-axis.y, axis.x) * e.z;
        if (round_depths(c, e.z, low, high, hides) && hides) hide_behind(c + half_chord, c - half_chord, high - e.z);
    }
    if (kListLanes > 1) share_hidden(of_list, lane);
    bool sky = params.sky_kind != 0 && !dark && any(equal(max(hidden[0], hidden[1]), vec4(kFar)));
    uvec4 emitting, before = uvec4(0u);
    float light_high;
    uvec4 kept = count_kept(centre, kFar, emitting, light_high);
    if (kListLanes > 1) share_kept(of_list, lane, kept, emitting, light_high, before);

    // Beyond the last light nothing matters, unless there is a sky, which what lies beyond may hide.
    bool lit = light_high > -kFar;
    float limit = params.sky_kind != 0 ? kFar : light_high;
    if (!lit && !sky) kept = uvec4(0u);
    if (kListLanes > 1 && params.sky_kind == 0) {
        // Here a list takes no more room than it needs: every lane must know where its pieces go.
        float unused;
        uvec4 sum = kept.x + kept.y + kept.z + kept.w > 0u ? count_kept(centre, limit, emitting, unused) : uvec4(0u);
        share_kept(of_list, lane, sum, emitting, unused, before);
        kept = sum;
    }
    uint room = kept.x + kept.y + 2u * kept.z + 4u * kept.w;
    uint begin = 0u;
    if (room > 0u && lane == 0) begin = atomicAdd(told[kExactToldEntries + params.told], room);
    if (kListLanes > 1) {
        if (lane == 0) list_begin[of_list] = begin;
        barrier();
        begin = list_begin[of_list];
        if (outside) return;
    }
    bool fits = begin + room <= uint(params.capacity);
    if (room == 0u || !fits) {
        if (lane == 0) write_head(list, sky ? kExactOpen : kExactDark, uvec4(0u), uvec4(0u));
        return;
    }

    vec4 e, ends;
    uint to = begin + before.x;
    if (kListLanes == 1) {
        kept = uvec4(0u);
        emitting = uvec4(0u);
    }
    for (uint i = part_from.x; i < part_to.x; ++i) {
        if (keeps_straight(i, centre, limit, e, high)) {
            out_entries[to] = e;
            out_lights[to] = texelFetch(lights, int(first_of.x + i));
            ++to;
            if (kListLanes == 1) {
                ++kept.x;
                if (i < lights_of.x) ++emitting.x;
            }
        }
    }
    if (kListLanes > 1) to = begin + kept.x + before.y;
    for (uint i = part_from.y; i < part_to.y; ++i) {
        if (keeps_round(first_of.y + i, centre, limit, e, high)) {
            out_entries[to] = e;
            out_lights[to] = texelFetch(lights, int(first_of.y + i));
            ++to;
            if (kListLanes == 1) {
                ++kept.y;
                if (i < lights_of.y) ++emitting.y;
            }
        }
    }
    if (kListLanes > 1) to = begin + kept.x + kept.y + 2u * before.z;
    if (kArcs != 0) for (uint i = part_from.z; i < part_to.z; ++i) {
        uint place = first_of.z + 2u * i;
        if (keeps_arc(place, centre, limit, e, ends, high)) {
            out_entries[to] = e;
            out_entries[to + 1u] = ends;
            out_lights[to] = texelFetch(lights, int(place));
            to += 2u;
            if (kListLanes == 1) {
                ++kept.z;
                if (i < lights_of.z) ++emitting.z;
            }
        }
    }
    if (kListLanes > 1) to = begin + kept.x + kept.y + 2u * kept.z + 4u * before.w;
    if (kEllipses != 0) for (uint i = part_from.w; i < part_to.w; ++i) {
        uint place = first_of.w + 4u * i;
        if (keeps_round(place, centre, limit, e, high)) {
            for (uint k = 0u; k < 4u; ++k) out_entries[to + k] = texelFetch(entries, int(place + k));
            out_lights[to] = texelFetch(lights, int(place));
            to += 4u;
            if (kListLanes == 1) {
                ++kept.w;
                if (i < lights_of.w) ++emitting.w;
            }
        }
    }
    if (lane > 0) return;
    uint total = kept.x + kept.y + kept.z + kept.w;
    write_head(list, total > 0u ? begin : (sky ? kExactOpen : kExactDark), kept, emitting);
    // Each step of the walk asks every entry; each entry starts and ends at most one interval.
    bool fits_head = params.wide != 0 ? all(lessThan(emitting, uvec4(65536u)))
                                      : kept.x < 65536u && kept.y < 65536u && kept.z < 256u && kept.w < 256u && total < 20000u;
    atomicMax(told[kExactToldWork + params.told], !fits_head ? kExactTooLong : params.wide != 0 ? 0u : (2u * total + 3u) * (total + 13u));
}
