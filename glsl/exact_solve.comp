// Solves points: for each, the pieces of outline that it sees, as intervals of direction, and from them its mean radiance,
// how that changes along x and y, a bound on its third derivatives, and a signature of what is seen. Nothing is sampled.
// One thread is four points of a tile; with kExactLanes, each takes a part of their sectors, and the first adds up. docs/methods/exact-gpu.md tells the method.
//
// Within a sector a direction is told by its key, the tangent of its angle from the sector's axis: axis + key * side.
// The walk goes from event to event: at each it finds the nearest piece (pieces never cross) and the next event.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactSolveGroupX, local_size_y = kExactLanes) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kExactHeadsUnit) uniform usamplerBuffer heads;
layout(binding = kExactEntriesUnit) uniform samplerBuffer entries;
layout(binding = kExactLightsUnit) uniform samplerBuffer lights;
layout(binding = kExactSectorsUnit) uniform samplerBuffer sectors;
layout(binding = kExactSkyUnit) uniform samplerBuffer sky_nodes;
layout(binding = kExactPointsUnit) uniform usamplerBuffer points;
layout(binding = kExactJobsUnit) uniform usamplerBuffer jobs;
layout(binding = kExactSurfacesUnit) uniform samplerBuffer surfaces;
layout(binding = kExactElementsUnit) uniform samplerBuffer elements;
layout(binding = kExactNodesUnit) uniform samplerBuffer nodes;
layout(binding = kExactValueImage, rgba32f) uniform image2D value_image;
layout(binding = kExactSlopeXImage, rgba32f) uniform image2D slope_x_image;
layout(binding = kExactSlopeYImage, rgba32f) uniform image2D slope_y_image;
layout(std430, binding = kExactCountersStorage) buffer Counters { uint counters[]; };

// Which program this is: Mesa 22 runs both sides of every branch and every loop once, so a scene gets no more than it needs.
const int kArcs = 1;      // lists hold arcs
const int kEllipses = 1;  // and ellipses
const int kSky = 2;       // 0: none, 1: constant, 2: nodes around the circle
const int kSlopes = 1;    // slopes and signatures are asked for
const int kSurfaces = 1;  // pieces shine differently from place to place: they reflect
const int kNodes = 1;     // points are elements of surfaces, and what is asked for is their irradiance
const int kMoment = 0;    // what radiance is weighted by: 0: nothing; 1, 2: the direction's x, y

const float kLookAhead = 1e-4;  // pieces that start at one corner are told apart a little further on
const float kTwoPi = 6.283185307179586;
// Loop iterations of one dispatch, under the 65,535 after which Mesa 22 ends all loops of a vector of eight; more where the driver ends
// none. A point that has spent them goes on in the next.
const int kBudget = 30000;
const float kNone = -1.0;       // nothing in this direction: the sky
const float kUnknown = -2.0;

#include "lib/exact_span.glsl"
#include "lib/exact_surface.glsl"

// The walk's state in this sector. Every vector that a loop carries costs Mesa 22 a masked copy each time round: few.
vec4 now;         // where it stands
vec4 next;        // the nearest event beyond
vec4 nearest;     // depth of the nearest piece
vec4 near_entry;
vec4 near_end;
vec4 near_far;    // no point of it lies deeper
vec4 light_start, light_end;  // no light is seen outside of these keys

void consider(int entry, Span span) {
    bvec4 covers = both(span.seen, both(lessThanEqual(span.start, now), lessThan(now, span.end)));
    bvec4 nearer = both(covers, lessThan(span.depth, nearest));
    nearest = pick(nearest, span.depth, nearer);
    near_entry = pick(near_entry, vec4(entry), nearer);
    near_end = pick(near_end, span.end, nearer);
    near_far = pick(near_far, max(span.start_depth, span.end_depth), nearer);
    // What starts behind the nearest piece found so far starts unseen.
    bvec4 open = either(greaterThanEqual(span.start, near_end), lessThanEqual(span.start_depth, near_far));
    next = pick(next, min(next, span.start), both(both(span.seen, greaterThan(span.start, now)), open));
}

void shine(Span span) {
    light_start = pick(light_start, min(light_start, span.start), span.seen);
    light_end = pick(light_end, max(light_end, span.end), span.seen);
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
    vec3 within = step * f * (here + 0.5 * f * (there - here));
    // The table of a moment holds the integral with the direction; so narrow a part has one direction.
    float middle = step * (float(node) + 0.5 * f);
    if (kMoment == 1) within *= cos(middle);
    if (kMoment == 2) within *= sin(middle);
    integral = total * turns + before + within;
    radiance = mix(here, there, f);
}

uint mixed(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// What the points gather.
vec4 sum_r, sum_g, sum_b;
vec4 slope_x_r, slope_x_g, slope_x_b, slope_y_r, slope_y_g, slope_y_b;
vec4 third;
uvec4 signature;
// The nearest piece since the key `from`.
vec4 top, top_end, top_far, top_end_depth, top_clearance, from;
vec4 top_r, top_g, top_b;
uvec4 top_id;

// The entries of this sector's list, by kind.
int first_straight, first_disc, first_arc, first_ellipse, end_entry;

vec3 sky_between(float a, float b, out vec3 at_b) {
    vec3 begin, end, before;
    sky_at(a, begin, before);
    sky_at(b, end, at_b);
    return end - begin;
}

// `weight`: what the integral counts for; 1 for the light of all directions alike.
void add_sky(bvec4 which, vec4 a, vec4 b, vec4 weight, out vec4 r, out vec4 g, out vec4 bl) {
    vec3 h0, h1, h2, h3;
    vec3 s0 = sky_between(a.x, b.x, h0);
    vec3 s1 = sky_between(a.y, b.y, h1);
    vec3 s2 = sky_between(a.z, b.z, h2);
    vec3 s3 = sky_between(a.w, b.w, h3);
    vec4 share = pick(vec4(0.0), weight, which);
    sum_r += share * vec4(s0.r, s1.r, s2.r, s3.r);
    sum_g += share * vec4(s0.g, s1.g, s2.g, s3.g);
    sum_b += share * vec4(s0.b, s1.b, s2.b, s3.b);
    r = vec4(h0.r, h1.r, h2.r, h3.r);
    g = vec4(h0.g, h1.g, h2.g, h3.g);
    bl = vec4(h0.b, h1.b, h2.b, h3.b);
}

uint sky_part(float angle) {
    float x = angle / kTwoPi;
    int node = min(int((x - floor(x)) * float(params.sky_nodes)), params.sky_nodes - 1);
    return uint(texelFetch(sky_nodes, 2 * node + 1).a);
}

#include "lib/exact_gather.glsl"

// The light of what was nearest from `from` to `to`.
void gather(bvec4 which, vec4 to, float sector_angle) {
    if (kSurfaces != 0) {
        bvec4 on_surface = both(which, greaterThanEqual(top, vec4(0.0)));
        gather_surfaces(on_surface, to);
        which = both(which, lessThan(top, vec4(0.0)));
    }
    vec4 angle = weight_of(from, to);
    bvec4 plain = which;
    if (kSky == 2) {
        bvec4 open = both(which, equal(top, vec4(kNone)));
        plain = both(which, notEqual(top, vec4(kNone)));
        vec4 r, g, b;
        vec4 share = vec4(1.0);
        if (kNodes != 0) share = angle / max(arctangent((to - from) / (1.0 + to * from)), vec4(1e-9));
        add_sky(open, sector_angle + arctangent(from), sector_angle + arctangent(to), share, r, g, b);
        top_r = pick(top_r, r, open);
        top_g = pick(top_g, g, open);
        top_b = pick(top_b, b, open);
    }
    angle = pick(vec4(0.0), angle, plain);
    sum_r += top_r * angle;
    sum_g += top_g * angle;
    sum_b += top_b * angle;
}

// Where the nearest piece changed, at `now`: the light so far, and what the edge between the two does to it.
void change(bvec4 changed, float sector_angle) {
    gather(changed, now, sector_angle);
    bvec4 found = greaterThanEqual(near_entry, vec4(0.0));
    ivec4 entry = ivec4(max(near_entry, vec4(0.0)));
    vec4 l0 = texelFetch(lights, entry.x), l1 = texelFetch(lights, entry.y);
    vec4 l2 = texelFetch(lights, entry.z), l3 = texelFetch(lights, entry.w);
    vec3 sky = kSky == 1 ? params.sky.rgb : vec3(0.0);
    vec4 r = pick(vec4(sky.r), vec4(l0.r, l1.r, l2.r, l3.r), found);
    vec4 g = pick(vec4(sky.g), vec4(l0.g, l1.g, l2.g, l3.g), found);
    vec4 b = pick(vec4(sky.b), vec4(l0.b, l1.b, l2.b, l3.b), found);
    if (kSky == 2) {
        vec4 sr, sg, sb;
        vec4 at = sector_angle + arctangent(now);
        add_sky(bvec4(false), at, at, vec4(0.0), sr, sg, sb);
        r = pick(sr, r, found);
        g = pick(sg, g, found);
        b = pick(sb, b, found);
    }
    if (kSurfaces != 0) {
        vec4 sr = vec4(0.0), sg = vec4(0.0), sb = vec4(0.0);
        for (int k = 0; k < 4; ++k) {
            vec4 lane = lane_of(k);
            float e = dot(lane, max(near_entry, vec4(0.0)));
            vec3 c = surface_at(int(e), kind_of(e), vec2(dot(lane, px), dot(lane, py)), dot(lane, now));
            sr += lane * c.r;
            sg += lane * c.g;
            sb += lane * c.b;
        }
        r = pick(r, sr, found);
        g = pick(g, sg, found);
        b = pick(b, sb, found);
    }
    // Which edge it is: between which two pieces; beside the sky also in which part of it, since a step changes the slope.
    uvec4 id = uvec4(pick(vec4(1.0), vec4(l0.a, l1.a, l2.a, l3.a) + 2.0, found));
    if (kSky == 2 && kSlopes != 0) {
        vec4 toward = sector_angle + arctangent(now);
        uvec4 part = 1u + (uvec4(sky_part(toward.x), sky_part(toward.y), sky_part(toward.z), sky_part(toward.w)) << 22);
        id = uvec4(found.x ? id.x : part.x, found.y ? id.y : part.y, found.z ? id.z : part.z, found.w ? id.w : part.w);
        bvec4 sky_before = equal(top, vec4(kNone));
        top_id = uvec4(sky_before.x ? part.x : top_id.x, sky_before.y ? part.y : top_id.y, sky_before.z ? part.z : top_id.z, sky_before.w ? part.w : top_id.w);
    }
    vec4 end_depth = vec4(1.0);
    vec4 clearance = vec4(kFar);
    if (kSlopes != 0) {
        // The new pieces once more, for where exactly they start and end.
        vec4 e0 = texelFetch(entries, entry.x), e1 = texelFetch(entries, entry.y), e2 = texelFetch(entries, entry.z), e3 = texelFetch(entries, entry.w);
        vec4 x0 = vec4(e0.x, e1.x, e2.x, e3.x), y0 = vec4(e0.y, e1.y, e2.y, e3.y);
        vec4 x1 = vec4(e0.z, e1.z, e2.z, e3.z), y1 = vec4(e0.w, e1.w, e2.w, e3.w);
        bvec4 round_ones = both(found, greaterThanEqual(near_entry, vec4(first_disc)));
        bvec4 arcs = both(found, greaterThanEqual(near_entry, vec4(first_arc)));
        bvec4 ellipses = both(found, greaterThanEqual(near_entry, vec4(first_ellipse)));
        Span span = straight_span(x0, y0, x1, y1, now);
        vec4 start = span.start, start_depth = span.start_depth;
        end_depth = span.end_depth;
        {
            Span other = disc_span(x0, y0, x1, now);
            start = pick(start, other.start, round_ones);
            start_depth = pick(start_depth, other.start_depth, round_ones);
            end_depth = pick(end_depth, other.end_depth, round_ones);
            clearance = pick(clearance, other.clearance, round_ones);
        }
        if (kArcs != 0) {
            e0 = texelFetch(entries, entry.x + 1);
            e1 = texelFetch(entries, entry.y + 1);
            e2 = texelFetch(entries, entry.z + 1);
            e3 = texelFetch(entries, entry.w + 1);
            Span other = arc_span(x0, y0, x1, vec4(e0.x, e1.x, e2.x, e3.x), vec4(e0.y, e1.y, e2.y, e3.y), vec4(e0.z, e1.z, e2.z, e3.z), vec4(e0.w, e1.w, e2.w, e3.w), now);
            start = pick(start, other.start, arcs);
            start_depth = pick(start_depth, other.start_depth, arcs);
            end_depth = pick(end_depth, other.end_depth, arcs);
            clearance = pick(clearance, other.clearance, arcs);
        }
        if (kEllipses != 0) {
            Span o0 = ellipse_at(entry.x, now), o1 = ellipse_at(entry.y, now), o2 = ellipse_at(entry.z, now), o3 = ellipse_at(entry.w, now);
            start = pick(start, vec4(o0.start.x, o1.start.y, o2.start.z, o3.start.w), ellipses);
            start_depth = pick(start_depth, vec4(o0.start_depth.x, o1.start_depth.y, o2.start_depth.z, o3.start_depth.w), ellipses);
            end_depth = pick(end_depth, vec4(o0.end_depth.x, o1.end_depth.y, o2.end_depth.z, o3.end_depth.w), ellipses);
            clearance = pick(clearance, vec4(o0.clearance.x, o1.clearance.y, o2.clearance.z, o3.clearance.w), ellipses);
        }
        // What ends, or what starts, makes the edge; the angle of an edge at distance d turns by 1 / d a pixel.
        bvec4 ends = both(greaterThanEqual(top, vec4(0.0)), lessThanEqual(top_end, now));
        bvec4 fold = both(ends, both(found, lessThan(abs(start - now), vec4(1e-6))));
        vec4 inverse = inversesqrt(1.0 + now * now);
        vec4 turn = inverse / max(pick(start_depth, top_end_depth, ends), vec4(1e-6));
        vec4 weight = pick(vec4(0.0), turn, both(changed, notEqual(top, vec4(kUnknown))));
        vec4 jr = top_r - r, jg = top_g - g, jb = top_b - b;
        add_slopes(jr, jg, jb, now, kMoment != 0 ? weight * direction_of(now) : weight);
        vec4 size = max(max(abs(jr), abs(jg)), abs(jb));
        vec4 closeness = max(turn, 1.0 / max(pick(clearance, top_clearance, ends), vec4(1e-6)));
        third += pick(vec4(0.0), size * closeness * closeness * closeness, greaterThan(weight, vec4(0.0)));
        bvec4 counts = both(greaterThan(weight, vec4(0.0)), either(greaterThan(size, vec4(0.0)), not(fold)));
        // Where the walk starts at a light, not at the sector's border, what hides the light there counts as well: else a beam
        // between two that hide it would not show.
        bvec4 begins = both(changed, both(equal(top, vec4(kUnknown)), greaterThan(now, vec4(-params.tan_half))));
        counts = either(counts, begins);
        uvec4 pair = top_id * 0x9e3779b9u + id;
        signature += uvec4(counts.x ? mixed(pair.x) : 0u, counts.y ? mixed(pair.y) : 0u, counts.z ? mixed(pair.z) : 0u, counts.w ? mixed(pair.w) : 0u);
    }
    top = pick(top, near_entry, changed);
    from = pick(from, now, changed);
    top_r = pick(top_r, r, changed);
    top_g = pick(top_g, g, changed);
    top_b = pick(top_b, b, changed);
    top_end_depth = pick(top_end_depth, end_depth, changed);
    top_clearance = pick(top_clearance, clearance, changed);
    top_id = uvec4(changed.x ? id.x : top_id.x, changed.y ? id.y : top_id.y, changed.z ? id.z : top_id.z, changed.w ? id.w : top_id.w);
}

#include "lib/exact_lanes.glsl"

int sectors_done(ivec2 point) { return params.continues != 0 ? int(imageLoad(slope_y_image, point).a) : 0; }

// What a point has gathered: sums while it is not done, means then.
void store(ivec2 point, int done, vec3 sum, uint seen, vec4 x, vec3 y) {
    float whole = done < params.sectors || kNodes != 0 ? 1.0 : kTwoPi;
    imageStore(value_image, point, vec4(sum / whole, float(seen & 0xffffffu)));
    imageStore(slope_x_image, point, x / whole);
    imageStore(slope_y_image, point, vec4(y / whole, float(done)));
}

ivec2 local_point(int first, int index, int count) {
    int place = int(texelFetch(points, first + min(index, count - 1)).r);
    return ivec2(place & 0xff, place >> 8);
}

ivec2 image_of(float element) { return ivec2(int(element) % kExactNodeRow, int(element) / kExactNodeRow); }

// Four points of one tile, the last of them repeated: where they are in the images, and which are inside of shapes.
// With lanes a job is done in one dispatch; `without_job`: there is none, but its lanes must meet the others.
void solve(int tile_index, ivec2 p0, ivec2 p1, ivec2 p2, ivec2 p3, bvec4 solid, bool without_job) {
    int s = kExactLanes > 1 ? lane() : sectors_done(p0);
    if (kExactLanes == 1 && s >= params.sectors) return;
    sum_r = vec4(0.0);
    sum_g = vec4(0.0);
    sum_b = vec4(0.0);
    slope_x_r = vec4(0.0);
    slope_x_g = vec4(0.0);
    slope_x_b = vec4(0.0);
    slope_y_r = vec4(0.0);
    slope_y_g = vec4(0.0);
    slope_y_b = vec4(0.0);
    third = vec4(0.0);
    signature = uvec4(0u);
    if (kExactLanes == 1 && params.continues != 0) {
        // The sums go on where they were: in how many dispatches they are made shows in no digit.
        vec4 v0 = imageLoad(value_image, p0), v1 = imageLoad(value_image, p1), v2 = imageLoad(value_image, p2), v3 = imageLoad(value_image, p3);
        sum_r = vec4(v0.r, v1.r, v2.r, v3.r);
        sum_g = vec4(v0.g, v1.g, v2.g, v3.g);
        sum_b = vec4(v0.b, v1.b, v2.b, v3.b);
        signature = uvec4(v0.a, v1.a, v2.a, v3.a);
        v0 = imageLoad(slope_x_image, p0);
        v1 = imageLoad(slope_x_image, p1);
        v2 = imageLoad(slope_x_image, p2);
        v3 = imageLoad(slope_x_image, p3);
        slope_x_r = vec4(v0.r, v1.r, v2.r, v3.r);
        slope_x_g = vec4(v0.g, v1.g, v2.g, v3.g);
        slope_x_b = vec4(v0.b, v1.b, v2.b, v3.b);
        third = vec4(v0.a, v1.a, v2.a, v3.a);
        v0 = imageLoad(slope_y_image, p0);
        v1 = imageLoad(slope_y_image, p1);
        v2 = imageLoad(slope_y_image, p2);
        v3 = imageLoad(slope_y_image, p3);
        slope_y_r = vec4(v0.r, v1.r, v2.r, v3.r);
        slope_y_g = vec4(v0.g, v1.g, v2.g, v3.g);
        slope_y_b = vec4(v0.b, v1.b, v2.b, v3.b);
    }
    int budget = kBudget;
    int list = tile_index * params.sectors;
    bool spent = false;
    if (all(solid) || without_job) s = params.sectors;
    for (; s < params.sectors; s += kExactLanes) {
        if (kExactLanes > 1) budget = kBudget;
        uvec4 head = texelFetch(heads, list + s);
        // Each entry starts and ends at most one interval, and each step of the walk asks every entry.
        int most = int((head.y & 0xffffu) + (head.z & 0xffffu) + (head.w & 0xffu) + ((head.w >> 16) & 0xffu));
        most = head.x >= kExactOpen ? 20 : (2 * most + 4) * (most + (kSurfaces != 0 ? 13 : 5));
        if (most > budget && budget < kBudget) break;
        if (head.x != kExactDark) {
            vec4 sector = texelFetch(sectors, s);
            axis = sector.xy;
            side = vec2(-axis.y, axis.x);
            first_straight = int(head.x);
            first_disc = first_straight + int(head.y & 0xffffu);
            first_arc = first_disc + int(head.z & 0xffffu);
            first_ellipse = first_arc + 2 * int(head.w & 0xffu);
            end_entry = first_ellipse + 4 * int((head.w >> 16) & 0xffu);
            if (head.x == kExactOpen) {
                first_straight = 0;
                first_disc = 0;
                first_arc = 0;
                first_ellipse = 0;
                end_entry = 0;
            }

            // Without a sky the walk goes from where the first light starts to where the last ends, a little more than that.
            now = vec4(-params.tan_half);
            vec4 limit = vec4(params.tan_half);
            if (kSky == 0) {
                int last_straight = first_straight + int(head.y >> 16);
                int last_disc = first_disc + int(head.z >> 16);
                int last_arc = first_arc + 2 * int((head.w >> 8) & 0xffu);
                int last_ellipse = first_ellipse + 4 * int(head.w >> 24);
                light_start = vec4(kFar);
                light_end = vec4(-kFar);
                budget -= 5 + last_straight - first_straight + last_disc - first_disc + last_arc - first_arc + last_ellipse - first_ellipse;
                for (int i = first_straight; i < last_straight; ++i) shine(straight_at(i, vec4(0.0)));
                for (int i = first_disc; i < last_disc; ++i) shine(disc_at(i, vec4(0.0)));
                if (kArcs != 0) for (int i = first_arc; i < last_arc; i += 2) shine(arc_at(i, vec4(0.0)));
                if (kEllipses != 0) for (int i = first_ellipse; i < last_ellipse; i += 4) shine(ellipse_at(i, vec4(0.0)));
                now = max(now, light_start - 2.0 * kLookAhead);
                limit = min(limit, light_end + 2.0 * kLookAhead);
            }
            from = now;
            top = vec4(kUnknown);
            top_end = vec4(-kFar);
            top_far = vec4(1.0);
            top_end_depth = vec4(1.0);
            top_clearance = vec4(kFar);
            top_r = vec4(0.0);
            top_g = vec4(0.0);
            top_b = vec4(0.0);
            top_id = uvec4(0u);
            bvec4 idle = solid;
            // What lies behind a surface does not light it.
            if (kNodes != 0) idle = lessThan(normal_x * axis.x + normal_y * axis.y, vec4(-params.tan_half));
            now = pick(now, limit, idle);
            while (any(lessThan(now, limit)) && budget > 0) {
                vec4 ahead = now + kLookAhead;
                next = limit;
                nearest = vec4(kFar);
                near_entry = vec4(kNone);
                // What was nearest hides as long as it goes on.
                near_end = pick(vec4(-kFar), top_end, greaterThan(top_end, now));
                near_far = top_far;
                budget -= 5 + end_entry - first_straight + (kSurfaces != 0 ? 8 : 0);
                for (int i = first_straight; i < first_disc; ++i) consider(i, straight_at(i, ahead));
                for (int i = first_disc; i < first_arc; ++i) consider(i, disc_at(i, ahead));
                if (kArcs != 0) for (int i = first_arc; i < first_ellipse; i += 2) consider(i, arc_at(i, ahead));
                if (kEllipses != 0) for (int i = first_ellipse; i < end_entry; i += 4) consider(i, ellipse_at(i, ahead));
                bvec4 found = greaterThanEqual(near_entry, vec4(0.0));
                next = pick(next, min(next, near_end), found);
                bvec4 changed = both(notEqual(near_entry, top), lessThan(now, limit));
                change(changed, sector.z);
                top_end = pick(vec4(-kFar), near_end, found);
                top_far = near_far;
                now = next;
            }
            gather(bvec4(true), max(now, from), sector.z);
            if (kSky == 0 && kSlopes != 0) {
                bvec4 counts = both(lessThan(limit, vec4(params.tan_half)), notEqual(top, vec4(kUnknown)));
                uvec4 pair = top_id * 0x85ebca6bu;
                signature += uvec4(counts.x ? mixed(pair.x) : 0u, counts.y ? mixed(pair.y) : 0u, counts.z ? mixed(pair.z) : 0u, counts.w ? mixed(pair.w) : 0u);
            }
        }
        if (kExactLanes > 1) spent = spent || budget <= 0;
    }
    if (kExactLanes > 1) {
        if (spent) atomicAdd(counters[kExactCountSpent], 1u);
        add_up_lanes();
        if (lane() > 0 || without_job) return;
        s = params.sectors;
        budget = kBudget;
    }

    // A list that takes more than a whole budget is cut off.
    if (s < params.sectors) atomicAdd(counters[kExactCountUnfinished], 1u);
    if (s >= params.sectors && budget <= 0) atomicAdd(counters[kExactCountSpent], 1u);
    store(p0, s, vec3(sum_r.x, sum_g.x, sum_b.x), signature.x, vec4(slope_x_r.x, slope_x_g.x, slope_x_b.x, third.x), vec3(slope_y_r.x, slope_y_g.x, slope_y_b.x));
    if (p1 != p0) store(p1, s, vec3(sum_r.y, sum_g.y, sum_b.y), signature.y, vec4(slope_x_r.y, slope_x_g.y, slope_x_b.y, third.y), vec3(slope_y_r.y, slope_y_g.y, slope_y_b.y));
    if (p2 != p1) store(p2, s, vec3(sum_r.z, sum_g.z, sum_b.z), signature.z, vec4(slope_x_r.z, slope_x_g.z, slope_x_b.z, third.z), vec3(slope_y_r.z, slope_y_g.z, slope_y_b.z));
    if (p3 != p2) store(p3, s, vec3(sum_r.w, sum_g.w, sum_b.w), signature.w, vec4(slope_x_r.w, slope_x_g.w, slope_x_b.w, third.w), vec3(slope_y_r.w, slope_y_g.w, slope_y_b.w));
}

// Of the points that a tile asks for.
void solve_points(int tile_index, int first, int count, bool without_job) {
    int row = tile_index / params.tiles.x;
    ivec2 origin = ivec2(tile_index - row * params.tiles.x, row) * kExactTile;
    int at = params.first_point + tile_index * params.tile_points;
    ivec2 p0 = origin + local_point(at, first, count);
    ivec2 p1 = origin + local_point(at, first + 1, count);
    ivec2 p2 = origin + local_point(at, first + 2, count);
    ivec2 p3 = origin + local_point(at, first + 3, count);
    ivec2 corner = ivec2(0, params.first_row);
    ivec2 last = params.canvas - 1;
    ivec2 x0 = min(corner + p0, last), x1 = min(corner + p1, last), x2 = min(corner + p2, last), x3 = min(corner + p3, last);
    px = vec4(x0.x, x1.x, x2.x, x3.x) + 0.5;
    py = vec4(x0.y, x1.y, x2.y, x3.y) + 0.5;
    // Without shapes the distance is a single texel.
    ivec2 end = textureSize(distance_texture, 0) - 1;
    vec4 room = vec4(texelFetch(distance_texture, min(x0 + params.border, end), 0).r, texelFetch(distance_texture, min(x1 + params.border, end), 0).r,
                     texelFetch(distance_texture, min(x2 + params.border, end), 0).r, texelFetch(distance_texture, min(x3 + params.border, end), 0).r);
    solve(tile_index, p0, p1, p2, p3, lessThanEqual(room, vec4(0.0)), without_job);
}

// Of the elements of surfaces.
void solve_nodes(int tile_index, int first, bool without_job) {
    vec4 n0 = texelFetch(nodes, 2 * first), n1 = texelFetch(nodes, 2 * first + 2), n2 = texelFetch(nodes, 2 * first + 4), n3 = texelFetch(nodes, 2 * first + 6);
    px = vec4(n0.x, n1.x, n2.x, n3.x);
    py = vec4(n0.y, n1.y, n2.y, n3.y);
    normal_x = vec4(n0.z, n1.z, n2.z, n3.z);
    normal_y = vec4(n0.w, n1.w, n2.w, n3.w);
    solve(tile_index, image_of(texelFetch(nodes, 2 * first + 1).r), image_of(texelFetch(nodes, 2 * first + 3).r),
          image_of(texelFetch(nodes, 2 * first + 5).r), image_of(texelFetch(nodes, 2 * first + 7).r), bvec4(false), without_job);
}

void main() {
    int index = int(gl_GlobalInvocationID.x) + params.origin.y * params.extent.x;
    int count = kNodes != 0 ? params.jobs : int(counters[kExactCountLevel + 4 * params.level]);
    bool without_job = index >= count;
    if (kExactLanes == 1 && without_job) return;
    // Lanes without a job look at the first one.
    if (kExactLanes > 1 && without_job) index = 0;
    uint job = texelFetch(jobs, index).r;
    if (kNodes != 0) {
        solve_nodes(int(job), 4 * index, without_job);
        return;
    }
    int tile = int(job & 0xffffffu);
    solve_points(tile, 4 * int(job >> 24), int(counters[params.first_count + tile]), without_job);
}
