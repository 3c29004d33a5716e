// Solves points: for each, the pieces of outline that it sees, as intervals of direction, and from them its mean radiance,
// how that changes along x and y, a bound on its third derivatives, and a signature of what is seen. Nothing is sampled.
// One thread is four points of a tile. docs/methods/exact-gpu.md tells the method.
//
// Within a sector a direction is told by its key, the tangent of its angle from the sector's axis: axis + key * side.
// The walk goes from event to event: at each it finds the nearest piece (pieces never cross) and the next event.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactSolveGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kExactHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kExactEntriesUnit) uniform samplerBuffer entries;
layout(binding = kExactIdsUnit) uniform usamplerBuffer ids;
layout(binding = kExactPieceLightUnit) uniform samplerBuffer piece_light;
layout(binding = kExactSectorsUnit) uniform samplerBuffer sectors;
layout(binding = kExactSkyUnit) uniform samplerBuffer sky_nodes;
layout(binding = kExactPointsUnit) uniform usamplerBuffer points;
layout(binding = kExactJobsUnit) uniform usamplerBuffer jobs;
layout(binding = kExactValueImage, rgba32f) uniform image2D value_image;
layout(binding = kExactSlopeXImage, rgba32f) uniform image2D slope_x_image;
layout(binding = kExactSlopeYImage, rgba32f) uniform image2D slope_y_image;
layout(std430, binding = kExactCountersStorage) buffer Counters { uint counters[]; };

const float kFar = 1e30;
const float kBehind = 1e9;      // key of what lies behind
const float kLookAhead = 1e-4;  // pieces that start at one corner are told apart a little further on
const float kTwoPi = 6.283185307179586;
// Loop iterations of one dispatch, under the 65,535 after which Mesa 22 ends all loops of a vector of eight. A point that
// has spent them goes on in the next.
const int kBudget = 30000;
const int kNone = -1;           // nothing in this direction: the sky
const int kUnknown = -2;

// Four points at once, in the four components of every vector: one fetch of a piece serves four, and their arithmetic
// overlaps.
bvec4 both(bvec4 a, bvec4 b) { return bvec4(a.x && b.x, a.y && b.y, a.z && b.z, a.w && b.w); }
bvec4 either(bvec4 a, bvec4 b) { return bvec4(a.x || b.x, a.y || b.y, a.z || b.z, a.w || b.w); }
vec4 pick(vec4 no, vec4 yes, bvec4 which) { return mix(no, yes, which); }

// The walk's state in this sector.
vec4 px, py;
vec2 axis, side;
vec4 now, ahead;        // keys: where it stands, and where distances are compared
vec4 next;              // the nearest event beyond
vec4 nearest;           // depth of the nearest piece
vec4 near_start, near_end, near_start_depth, near_end_depth, near_rho;
vec4 near_entry;
bvec4 in_light;         // an emitting piece lies in this direction, hidden or not
bvec4 light_left;       // or further on in this sector

// One piece, seen from the points: keys and depths of its ends, its depth at `ahead`, and how near the curve that it is
// part of comes (its ends move on it).
void consider(int entry, bool emits, bvec4 faces, vec4 ks, vec4 ke, vec4 ds, vec4 de, vec4 depth, vec4 rho) {
    bvec4 seen = both(faces, greaterThan(max(ds, de), vec4(0.0)));
    bvec4 covers = both(seen, both(lessThanEqual(ks, now), lessThan(now, ke)));
    bvec4 nearer = both(covers, lessThan(depth, nearest));
    nearest = pick(nearest, depth, nearer);
    near_entry = pick(near_entry, vec4(entry), nearer);
    near_start = pick(near_start, ks, nearer);
    near_end = pick(near_end, ke, nearer);
    near_start_depth = pick(near_start_depth, ds, nearer);
    near_end_depth = pick(near_end_depth, de, nearer);
    near_rho = pick(near_rho, rho, nearer);
    // What starts behind the nearest piece found so far starts unseen.
    bvec4 open = either(greaterThanEqual(ks, near_end), lessThanEqual(ds, max(near_start_depth, near_end_depth)));
    next = pick(next, min(next, ks), both(both(seen, greaterThan(ks, now)), open));
    if (emits) {
        in_light = either(in_light, covers);
        light_left = either(light_left, both(seen, greaterThan(ke, now)));
    }
}

// Ends as vectors from the points: towards growing angles the piece goes from s to e.
void ends_of(vec4 sx, vec4 sy, vec4 ex, vec4 ey, out vec4 ks, out vec4 ke, out vec4 ds, out vec4 de) {
    ds = axis.x * sx + axis.y * sy;
    de = axis.x * ex + axis.y * ey;
    ks = pick(vec4(-kBehind), (side.x * sx + side.y * sy) / ds, greaterThan(ds, vec4(0.0)));
    ke = pick(vec4(kBehind), (side.x * ex + side.y * ey) / de, greaterThan(de, vec4(0.0)));
}

void consider_straight(int entry, bool emits) {
    vec4 piece = texelFetch(entries, entry);
    vec4 ax = piece.x - px, ay = piece.y - py;
    vec4 bx = piece.z - px, by = piece.w - py;
    vec2 e = piece.zw - piece.xy;
    vec4 rise = ax * e.y - ay * e.x;
    vec4 ks, ke, ds, de;
    ends_of(bx, by, ax, ay, ks, ke, ds, de);
    float along = axis.x * e.y - axis.y * e.x;
    float across = side.x * e.y - side.y * e.x;
    vec4 depth = rise / min(along + across * ahead, vec4(-1e-30));
    consider(entry, emits, lessThan(rise, vec4(0.0)), ks, ke, ds, de, depth, vec4(kFar));
}

// A circle seen from outside: the points where rays touch it are v turned by the angle of sine r / |v| either way, of
// length t; and its near side's depth at `ahead`.
void touch(vec4 vx, vec4 vy, float radius, out vec4 d2, out vec4 rise, out vec4 sx, out vec4 sy, out vec4 ex, out vec4 ey,
           out vec4 depth) {
    d2 = vx * vx + vy * vy;
    rise = d2 - radius * radius;
    vec4 t = sqrt(max(rise, vec4(0.0)));
    vec4 k = t / max(d2, vec4(1e-30));
    vec4 tk = t * k;
    vec4 rk = radius * k;
    sx = vx * tk + vy * rk;
    sy = vy * tk - vx * rk;
    ex = vx * tk - vy * rk;
    ey = vy * tk + vx * rk;
    vec4 wx = axis.x + side.x * ahead, wy = axis.y + side.y * ahead;
    vec4 b = vx * wx + vy * wy;
    depth = rise / max(b + sqrt(max(b * b - (1.0 + ahead * ahead) * rise, vec4(0.0))), vec4(1e-30));
}

void consider_disc(int entry, bool emits) {
    vec4 piece = texelFetch(entries, entry);
    vec4 d2, rise, sx, sy, ex, ey, depth, ks, ke, ds, de;
    touch(piece.x - px, piece.y - py, piece.z, d2, rise, sx, sy, ex, ey, depth);
    ends_of(sx, sy, ex, ey, ks, ke, ds, de);
    consider(entry, emits, greaterThan(rise, vec4(0.0)), ks, ke, ds, de, depth, sqrt(d2) - piece.z);
}

void consider_arc(int entry, bool emits) {
    vec4 piece = texelFetch(entries, entry);
    vec4 ends = texelFetch(entries, entry + 1);
    vec4 vx = piece.x - px, vy = piece.y - py;
    vec4 d2, rise, sx, sy, ex, ey, depth, ks, ke, ds, de;
    touch(vx, vy, piece.z, d2, rise, sx, sy, ex, ey, depth);
    vec2 ra = ends.xy - piece.xy;  // from the centre
    vec2 rb = ends.zw - piece.xy;
    bvec4 front_a = lessThan(ra.x * (ends.x - px) + ra.y * (ends.y - py), vec4(0.0));
    bvec4 front_b = lessThan(rb.x * (ends.z - px) + rb.y * (ends.w - py), vec4(0.0));
    // With both ends behind the horizon the arc shows its middle, or nothing.
    bvec4 within = both(lessThan(ra.x * vy - ra.y * vx, vec4(0.0)), lessThan(vx * rb.y - vy * rb.x, vec4(0.0)));
    bvec4 shows = either(within, either(front_a, front_b));
    sx = pick(sx, ends.z - px, front_b);
    sy = pick(sy, ends.w - py, front_b);
    ex = pick(ex, ends.x - px, front_a);
    ey = pick(ey, ends.y - py, front_a);
    ends_of(sx, sy, ex, ey, ks, ke, ds, de);
    consider(entry, emits, both(shows, greaterThan(rise, vec4(0.0))), ks, ke, ds, de, depth, sqrt(d2) - piece.z);
}

void consider_ellipse(int entry, bool emits) {
    vec4 head = texelFetch(entries, entry);
    vec4 frame = texelFetch(entries, entry + 1);
    vec4 ends = texelFetch(entries, entry + 2);
    vec4 back = texelFetch(entries, entry + 3);
    // In the frame where the ellipse is the unit circle.
    vec4 fx = px - head.x, fy = py - head.y;
    vec4 qx = frame.x * fx + frame.y * fy;
    vec4 qy = frame.z * fx + frame.w * fy;
    vec4 norm = qx * qx + qy * qy;
    vec4 rise = norm - 1.0;
    vec4 t = sqrt(max(rise, vec4(0.0)));
    vec4 k = 1.0 / max(norm, vec4(1e-30));
    vec4 hx = (qx - qy * t) * k, hy = (qy + qx * t) * k;  // touching points, of larger and smaller parameter
    vec4 lx = (qx + qy * t) * k, ly = (qy - qx * t) * k;
    vec4 sx = back.x * hx + back.z * hy - fx, sy = back.y * hx + back.w * hy - fy;
    vec4 ex = back.x * lx + back.z * ly - fx, ey = back.y * lx + back.w * ly - fy;
    vec2 a = ends.xy - head.xy;
    vec2 b = ends.zw - head.xy;
    vec2 ea = vec2(dot(frame.xy, a), dot(frame.zw, a));
    vec2 eb = vec2(dot(frame.xy, b), dot(frame.zw, b));
    bvec4 part = bvec4(head.w == 0.0);
    bvec4 front_a = both(part, greaterThan(ea.x * qx + ea.y * qy, vec4(1.0)));
    bvec4 front_b = both(part, greaterThan(eb.x * qx + eb.y * qy, vec4(1.0)));
    bvec4 within = both(greaterThan(ea.x * qy - ea.y * qx, vec4(0.0)), greaterThan(qx * eb.y - qy * eb.x, vec4(0.0)));
    bvec4 shows = either(not(part), either(within, either(front_a, front_b)));
    sx = pick(sx, ends.z - px, front_b);
    sy = pick(sy, ends.w - py, front_b);
    ex = pick(ex, ends.x - px, front_a);
    ey = pick(ey, ends.y - py, front_a);
    vec4 ks, ke, ds, de;
    ends_of(sx, sy, ex, ey, ks, ke, ds, de);
    vec4 dx = axis.x + side.x * ahead, dy = axis.y + side.y * ahead;
    vec4 wx = frame.x * dx + frame.y * dy;
    vec4 wy = frame.z * dx + frame.w * dy;
    vec4 beta = -(qx * wx + qy * wy);
    vec4 depth = rise / max(beta + sqrt(max(beta * beta - (wx * wx + wy * wy) * rise, vec4(0.0))), vec4(1e-30));
    float shorter = min(length(back.xy), length(back.zw));
    consider(entry, emits, both(shows, greaterThan(rise, vec4(0.0))), ks, ke, ds, de, depth, (sqrt(norm) - 1.0) * shorter);
}

// Integral of the sky's radiance from angle 0 on, and its radiance there.
void sky_at(float angle, out vec3 integral, out vec3 radiance) {
    float x = angle / kTwoPi;
    float turns = floor(x);
    x = (x - turns) * float(params.sky_nodes);
    int node = min(int(x), params.sky_nodes - 1);
    float f = x - float(node);
    float step = kTwoPi / float(params.sky_nodes);
    vec3 before = texelFetch(sky_nodes, 2 * node).rgb;
    vec3 here = texelFetch(sky_nodes, 2 * node + 1).rgb;
    vec3 there = texelFetch(sky_nodes, 2 * node + 3).rgb;
    vec3 total = texelFetch(sky_nodes, 2 * params.sky_nodes).rgb;
    integral = total * turns + before + step * f * (here + 0.5 * f * (there - here));
    radiance = mix(here, there, f);
}

uint mixed(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// Everything of one point whose nearest piece changed: its light so far, and what the edge between does to it.
struct Point {
    vec3 sum, slope_x, slope_y;
    float third;
    uint signature;
    vec3 light;   // of the nearest piece, since the key `from`
    float from;
    int top;      // its entry
    int top_id;
};

float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }

void change(inout Point q, float at, int entry, float start, float start_depth, float rho, float top_end,
            float top_end_depth, float top_rho, bool lit, float sector_angle) {
    vec3 new_light = params.sky_kind == 1 ? params.sky.rgb : vec3(0.0);
    int id = kNone;
    if (entry != kNone) {
        id = int(texelFetch(ids, entry).r);
        new_light = texelFetch(piece_light, id).rgb;
    }
    float angle = atan((at - q.from) / (1.0 + at * q.from));
    q.sum += q.light * (params.sky_kind == 2 && q.top == kNone ? 0.0 : angle);
    for (bool skies = params.sky_kind == 2; skies; skies = false) {
        vec3 begin, end, before, here;
        sky_at(sector_angle + atan(at), end, here);
        sky_at(sector_angle + atan(q.from), begin, before);
        if (entry == kNone) new_light = here;
        if (q.top == kNone) {
            q.sum += end - begin;
            q.light = here;
        }
    }
    for (bool broken = q.top != kUnknown && params.with_slopes != 0; broken; broken = false) {
        // What ends, or what starts, makes the edge; the angle of an edge at distance d turns by 1 / d a pixel.
        bool starts = entry != kNone && start == at;
        bool fold = starts && q.top >= 0 && top_end == at;
        float inverse = inversesqrt(1.0 + at * at);
        vec2 direction = (axis + side * at) * inverse;
        float turn = inverse / max(starts ? start_depth : top_end_depth, 1e-6);
        vec3 jump = q.light - new_light;
        q.slope_x += jump * (direction.y * turn);
        q.slope_y -= jump * (direction.x * turn);
        float size = largest(abs(jump));
        float closeness = max(turn, 1.0 / max(starts ? rho : top_rho, 1e-6));
        q.third += size * closeness * closeness * closeness;
        if (size > 0.0 || (lit && !fold)) q.signature += mixed(uint(q.top_id) * 0x9e3779b9u + uint(id + 2));
    }
    q.light = new_light;
    q.top = entry;
    q.top_id = id + 2;
    q.from = at;
}

// The rest of the sector.
void finish(inout Point q, float sector_angle) {
    float angle = atan((params.tan_half - q.from) / (1.0 + params.tan_half * q.from));
    for (bool skies = params.sky_kind == 2 && q.top == kNone; skies; skies = false) {
        vec3 begin, end, radiance;
        sky_at(sector_angle + atan(params.tan_half), end, radiance);
        sky_at(sector_angle + atan(q.from), begin, radiance);
        q.sum += end - begin;
        angle = 0.0;
    }
    q.sum += q.light * angle;
}

void begin_sector(inout Point q) {
    q.light = vec3(0.0);
    q.from = -params.tan_half;
    q.top = kUnknown;
    q.top_id = 0;
}

void begin_point(inout Point q) {
    q.sum = q.slope_x = q.slope_y = vec3(0.0);
    q.third = 0.0;
    q.signature = 0u;
    begin_sector(q);
}

int resume(ivec2 block) { return params.continues != 0 ? int(imageLoad(slope_y_image, block).a) : 0; }

void store(Point q, ivec2 block, int done) {
    vec4 value = vec4(q.sum / kTwoPi, float(q.signature & 0xffffffu));
    vec4 x = vec4(q.slope_x, q.third) / kTwoPi;
    vec4 y = vec4(q.slope_y / kTwoPi, float(done));
    for (bool again = params.continues != 0; again; again = false) {
        vec4 before = imageLoad(value_image, block);
        value.a = float((q.signature + uint(before.a)) & 0xffffffu);
        value.rgb += before.rgb;
        x += imageLoad(slope_x_image, block);
        y.rgb += imageLoad(slope_y_image, block).rgb;
    }
    imageStore(value_image, block, value);
    imageStore(slope_x_image, block, x);
    imageStore(slope_y_image, block, y);
}

ivec2 local_point(int first, int index, int count) {
    int place = int(texelFetch(points, first + min(index, count - 1)).r);
    return ivec2(place & 0xff, place >> 8);
}

// Four points of one tile: its corners, or four of those asked for; the last are repeated.
void solve(int tile_index, int first, int count) {
    int row = tile_index / params.tiles.x;
    ivec2 tile = ivec2(tile_index - row * params.tiles.x, row);
    ivec2 p0 = ivec2(0), p1 = ivec2(kExactTile, 0), p2 = ivec2(0, kExactTile), p3 = ivec2(kExactTile);
    if (params.all_points == 0) {
        int from = params.first_point + tile_index * params.tile_points;
        p0 = local_point(from, first, count);
        p1 = local_point(from, first + 1, count);
        p2 = local_point(from, first + 2, count);
        p3 = local_point(from, first + 3, count);
    }
    ivec2 origin = tile * kExactBlock;
    int s = resume(origin + p0);
    if (s >= params.sectors) return;
    ivec2 corner = tile * kExactTile + ivec2(0, params.first_row);
    ivec2 last = params.canvas - 1;
    ivec2 x0 = min(corner + p0, last), x1 = min(corner + p1, last), x2 = min(corner + p2, last), x3 = min(corner + p3, last);
    px = vec4(x0.x, x1.x, x2.x, x3.x) + 0.5;
    py = vec4(x0.y, x1.y, x2.y, x3.y) + 0.5;
    vec4 room = vec4(texelFetch(distance_texture, x0 + params.border, 0).r, texelFetch(distance_texture, x1 + params.border, 0).r,
                     texelFetch(distance_texture, x2 + params.border, 0).r, texelFetch(distance_texture, x3 + params.border, 0).r);
    bvec4 solid = lessThanEqual(room, vec4(0.0));

    Point q0, q1, q2, q3;
    begin_point(q0);
    begin_point(q1);
    begin_point(q2);
    begin_point(q3);
    int budget = kBudget;
    int list = tile_index * params.sectors;
    if (all(solid)) s = params.sectors;
    for (; s < params.sectors; ++s) {
        uvec4 head = texelFetch(heads, list + s);
        // Each entry starts and ends at most one interval, and each step of the walk asks every entry.
        int most = int((head.y & 0xffffu) + (head.z & 0xffffu) + (head.w & 0xffu) + ((head.w >> 16) & 0xffu));
        most = head.x >= kExactOpen ? 10 : (2 * most + 3) * (most + 5);
        if (most > budget && budget < kBudget) break;
        vec4 sector = texelFetch(sectors, s);
        axis = sector.xy;
        side = vec2(-axis.y, axis.x);
        int first_straight = int(head.x);
        int first_disc = first_straight + int(head.y & 0xffffu);
        int first_arc = first_disc + int(head.z & 0xffffu);
        int first_ellipse = first_arc + 2 * int(head.w & 0xffu);
        int end_entry = first_ellipse + 4 * int((head.w >> 16) & 0xffu);
        int last_straight_light = first_straight + int(head.y >> 16);
        int last_disc_light = first_disc + int(head.z >> 16);
        int last_arc_light = first_arc + 2 * int((head.w >> 8) & 0xffu);
        int last_ellipse_light = first_ellipse + 4 * int(head.w >> 24);
        if (head.x >= kExactOpen) first_disc = first_arc = first_ellipse = end_entry = first_straight;

        begin_sector(q0);
        begin_sector(q1);
        begin_sector(q2);
        begin_sector(q3);
        vec4 top = vec4(kUnknown);
        vec4 top_end = vec4(-kFar);
        vec4 top_start_depth = vec4(1.0);
        vec4 top_end_depth = vec4(1.0);
        vec4 top_rho = vec4(kFar);
        vec4 limit = vec4(params.tan_half);
        now = pick(vec4(-params.tan_half), limit, solid);
        if (head.x == kExactDark) now = limit;
        while (any(lessThan(now, limit)) && budget > 0) {
            ahead = now + kLookAhead;
            next = limit;
            nearest = vec4(kFar);
            near_entry = vec4(kNone);
            // What was nearest hides as long as it goes on.
            near_start = vec4(kFar);
            near_end = pick(vec4(-kFar), top_end, greaterThan(top_end, now));
            near_start_depth = top_start_depth;
            near_end_depth = top_end_depth;
            near_rho = vec4(kFar);
            in_light = bvec4(params.sky_kind != 0);
            light_left = in_light;
            budget -= 5 + end_entry - first_straight;
            for (int i = first_straight; i < first_disc; ++i) consider_straight(i, i < last_straight_light);
            for (int i = first_disc; i < first_arc; ++i) consider_disc(i, i < last_disc_light);
            for (int i = first_arc; i < first_ellipse; i += 2) consider_arc(i, i < last_arc_light);
            for (int i = first_ellipse; i < end_entry; i += 4) consider_ellipse(i, i < last_ellipse_light);
            bvec4 found = greaterThanEqual(near_entry, vec4(0.0));
            next = pick(next, min(next, near_end), found);
            // Loops, since Mesa 22 skips loops that no invocation enters, but no branches.
            bvec4 changed = both(notEqual(near_entry, top), lessThan(now, limit));
            for (bool go = changed.x; go; go = false)
                change(q0, now.x, int(near_entry.x), near_start.x, near_start_depth.x, near_rho.x, top_end.x, top_end_depth.x,
                       top_rho.x, in_light.x, sector.z);
            for (bool go = changed.y; go; go = false)
                change(q1, now.y, int(near_entry.y), near_start.y, near_start_depth.y, near_rho.y, top_end.y, top_end_depth.y,
                       top_rho.y, in_light.y, sector.z);
            for (bool go = changed.z; go; go = false)
                change(q2, now.z, int(near_entry.z), near_start.z, near_start_depth.z, near_rho.z, top_end.z, top_end_depth.z,
                       top_rho.z, in_light.z, sector.z);
            for (bool go = changed.w; go; go = false)
                change(q3, now.w, int(near_entry.w), near_start.w, near_start_depth.w, near_rho.w, top_end.w, top_end_depth.w,
                       top_rho.w, in_light.w, sector.z);
            top = pick(top, near_entry, changed);
            top_end = pick(vec4(-kFar), near_end, found);
            top_start_depth = near_start_depth;
            top_end_depth = near_end_depth;
            top_rho = near_rho;
            now = pick(limit, next, light_left);
        }
        for (bool go = head.x != kExactDark; go; go = false) {
            finish(q0, sector.z);
            finish(q1, sector.z);
            finish(q2, sector.z);
            finish(q3, sector.z);
        }
    }

    // A list that takes more than a whole budget is cut off.
    if (s < params.sectors || budget <= 0) atomicAdd(counters[s < params.sectors ? kExactCountUnfinished : kExactCountSpent], 1u);
    store(q0, origin + p0, s);
    if (p1 != p0) store(q1, origin + p1, s);
    if (p2 != p1) store(q2, origin + p2, s);
    if (p3 != p2) store(q3, origin + p3, s);
}

void main() {
    int index = int(gl_GlobalInvocationID.x);
    int jobs_given = params.all_points != 0 ? params.extent.x : int(counters[kExactCountLevel + 4 * params.level]);
    // A loop, since Mesa 22 skips loops that no invocation enters, but no branches.
    for (bool go = index < jobs_given; go; go = false) {
        uint job = params.all_points != 0 ? uint(index) : texelFetch(jobs, index).r;
        int tile = int(job & 0xffffffu);
        solve(tile, 4 * int(job >> 24), params.all_points != 0 ? 4 : int(counters[params.first_count + tile]));
    }
}
