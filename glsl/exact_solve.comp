// Solves points: for each, the pieces of outline that it sees, as intervals of direction, and from them its mean radiance,
// how that changes along x and y, a bound on its third derivatives, and a signature of what is seen. Nothing is sampled.
// One thread is four points of a tile, or (kExactLanes) some of the sectors of one point. docs/methods/exact-gpu.md tells the method.
//
// Within a sector a direction is told by its key, the tangent of its angle from the sector's axis: axis + key * side.
// The walk goes from event to event: at each it finds the nearest piece (pieces never cross) and the next event.
#version 430 core
#include "exact.h"

layout(local_size_x = kExactSolveThreads) in;
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
layout(std430, binding = kExactToldStorage) buffer ToldCounters { uint told[]; };

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
reals now;         // where it stands
reals next;        // the nearest event beyond
reals nearest;     // depth of the nearest piece
reals near_entry;
reals near_end;
reals near_far;    // no point of it lies deeper
reals light_start, light_end;  // no light is seen outside of these keys

// The entries of this sector's list, by kind.
int first_straight, first_disc, first_arc, first_ellipse, end_entry;

#if EXACT_WIDTH == 4

void consider(int entry, Span span) {
    bools covers = both(span.seen, both(le(span.start, now), lt(now, span.end)));
    bools nearer = both(covers, lt(span.depth, nearest));
    nearest = pick(nearest, span.depth, nearer);
    near_entry = pick(near_entry, reals(entry), nearer);
    near_end = pick(near_end, span.end, nearer);
    near_far = pick(near_far, max(span.start_depth, span.end_depth), nearer);
    // What starts behind the nearest piece found so far starts unseen.
    bools open = either(ge(span.start, near_end), le(span.start_depth, near_far));
    next = pick(next, min(next, span.start), both(both(span.seen, gt(span.start, now)), open));
}

void consider_straights(reals ahead) {
    for (int i = first_straight; i < first_disc; ++i) consider(i, straight_at(i, ahead));
}

#else

// As above, with branches in place of choices: neighbouring threads mostly take the same.
void consider(int entry, Span span) {
    if (!span.seen || span.end <= now) return;
    if (span.start > now) {
        if (span.start < next && (span.start >= near_end || span.start_depth <= near_far)) next = span.start;
    } else if (span.depth < nearest) {
        nearest = span.depth;
        near_entry = float(entry);
        near_end = span.end;
        near_far = max(span.start_depth, span.end_depth);
    }
}

// The next piece is on its way while this one is looked at.
void consider_straights(float ahead) {
    vec4 e = texelFetch(entries, first_straight);
    for (int i = first_straight; i < first_disc; ++i) {
        vec4 coming = texelFetch(entries, i + 1);
        consider(i, straight_span(e.x, e.y, e.z, e.w, ahead));
        e = coming;
    }
}

#endif

void shine(Span span) {
    light_start = pick(light_start, min(light_start, span.start), span.seen);
    light_end = pick(light_end, max(light_end, span.end), span.seen);
}

uints mixed(uints x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// What the points gather.
reals sum_r, sum_g, sum_b;
reals slope_x_r, slope_x_g, slope_x_b, slope_y_r, slope_y_g, slope_y_b;
reals third;
uints signature;
// The nearest piece since the key `from`.
reals top, top_end, top_far, top_end_depth, top_clearance, from;
reals top_r, top_g, top_b;
uints top_id;

#include "lib/exact_sky.glsl"
#include "lib/exact_gather.glsl"

// The light of what was nearest from `from` to `to`.
void gather(bools which, reals to, float sector_angle) {
    if (kSurfaces != 0) {
        bools on_surface = both(which, ge(top, reals(0.0)));
        gather_surfaces(on_surface, to);
        which = both(which, lt(top, reals(0.0)));
    }
    reals angle = weight_of(from, to);
    bools plain = which;
    if (kSky == 2) {
        bools open = both(which, eq(top, reals(kNone)));
        plain = both(which, ne(top, reals(kNone)));
        reals r, g, b;
        reals share = reals(1.0);
        if (kNodes != 0) share = angle / max(arctangent((to - from) / (1.0 + to * from)), reals(1e-9));
        add_sky(open, sector_angle + arctangent(from), sector_angle + arctangent(to), share, r, g, b);
        top_r = pick(top_r, r, open);
        top_g = pick(top_g, g, open);
        top_b = pick(top_b, b, open);
    }
    angle = pick(reals(0.0), angle, plain);
    sum_r += top_r * angle;
    sum_g += top_g * angle;
    sum_b += top_b * angle;
}

// Where the nearest piece changed, at `now`: the light so far, and what the edge between the two does to it.
void change(bools changed, float sector_angle) {
    gather(changed, now, sector_angle);
    bools found = ge(near_entry, reals(0.0));
    ints entry = ints(max(near_entry, reals(0.0)));
    reals r, g, b, piece;
    fetch_each(lights, entry, r, g, b, piece);
    vec3 sky = kSky == 1 ? params.sky.rgb : vec3(0.0);
    r = pick(reals(sky.r), r, found);
    g = pick(reals(sky.g), g, found);
    b = pick(reals(sky.b), b, found);
    if (kSky == 2) {
        reals sr, sg, sb;
        reals at = sector_angle + arctangent(now);
        add_sky(bools(false), at, at, reals(0.0), sr, sg, sb);
        r = pick(sr, r, found);
        g = pick(sg, g, found);
        b = pick(sb, b, found);
    }
    if (kSurfaces != 0) {
        reals sr = reals(0.0), sg = reals(0.0), sb = reals(0.0);
        for (int k = 0; k < EXACT_WIDTH; ++k) {
            reals lane = only(k);
            float e = dot(lane, max(near_entry, reals(0.0)));
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
    uints id = uints(pick(reals(1.0), piece + 2.0, found));
    if (kSky == 2 && kSlopes != 0) {
        reals toward = sector_angle + arctangent(now);
        uints part = 1u + (sky_parts(toward) << 22);
        id = pick(part, id, found);
        top_id = pick(top_id, part, eq(top, reals(kNone)));
    }
    reals end_depth = reals(1.0);
    reals clearance = reals(kFar);
    if (kSlopes != 0) {
        // The new pieces once more, for where exactly they start and end.
        reals x0, y0, x1, y1;
        fetch_each(entries, entry, x0, y0, x1, y1);
        bools round_ones = both(found, ge(near_entry, reals(first_disc)));
        bools arcs = both(found, ge(near_entry, reals(first_arc)));
        bools ellipses = both(found, ge(near_entry, reals(first_ellipse)));
        Span span = straight_span(x0, y0, x1, y1, now);
        reals start = span.start, start_depth = span.start_depth;
        end_depth = span.end_depth;
        if (EXACT_WIDTH > 1 || any_of(round_ones)) {
            Span other = disc_span(x0, y0, x1, now);
            start = pick(start, other.start, round_ones);
            start_depth = pick(start_depth, other.start_depth, round_ones);
            end_depth = pick(end_depth, other.end_depth, round_ones);
            clearance = pick(clearance, other.clearance, round_ones);
        }
        if (kArcs != 0 && (EXACT_WIDTH > 1 || any_of(arcs))) {
            reals ax, ay, bx, by;
            fetch_each(entries, entry + 1, ax, ay, bx, by);
            Span other = arc_span(x0, y0, x1, ax, ay, bx, by, now);
            start = pick(start, other.start, arcs);
            start_depth = pick(start_depth, other.start_depth, arcs);
            end_depth = pick(end_depth, other.end_depth, arcs);
            clearance = pick(clearance, other.clearance, arcs);
        }
        if (kEllipses != 0 && (EXACT_WIDTH > 1 || any_of(ellipses))) {
            Span other = ellipses_at(entry, now);
            start = pick(start, other.start, ellipses);
            start_depth = pick(start_depth, other.start_depth, ellipses);
            end_depth = pick(end_depth, other.end_depth, ellipses);
            clearance = pick(clearance, other.clearance, ellipses);
        }
        // What ends, or what starts, makes the edge; the angle of an edge at distance d turns by 1 / d a pixel.
        bools ends = both(ge(top, reals(0.0)), le(top_end, now));
        bools fold = both(ends, both(found, lt(abs(start - now), reals(1e-6))));
        reals inverse = inversesqrt(1.0 + now * now);
        reals turn = inverse / max(pick(start_depth, top_end_depth, ends), reals(1e-6));
        reals weight = pick(reals(0.0), turn, both(changed, ne(top, reals(kUnknown))));
        reals jr = top_r - r, jg = top_g - g, jb = top_b - b;
        add_slopes(jr, jg, jb, now, kMoment != 0 ? weight * direction_of(now) : weight);
        reals size = max(max(abs(jr), abs(jg)), abs(jb));
        reals closeness = max(turn, 1.0 / max(pick(clearance, top_clearance, ends), reals(1e-6)));
        third += pick(reals(0.0), size * closeness * closeness * closeness, gt(weight, reals(0.0)));
        bools counts = both(gt(weight, reals(0.0)), either(gt(size, reals(0.0)), opposite(fold)));
        // Where the walk starts at a light, not at the sector's border, what hides the light there counts as well: else a beam
        // between two that hide it would not show.
        bools begins = both(changed, both(eq(top, reals(kUnknown)), gt(now, reals(-params.tan_half))));
        counts = either(counts, begins);
        uints pair = top_id * 0x9e3779b9u + id;
        signature += pick(uints(0u), mixed(pair), counts);
    }
    top = pick(top, near_entry, changed);
    from = pick(from, now, changed);
    top_r = pick(top_r, r, changed);
    top_g = pick(top_g, g, changed);
    top_b = pick(top_b, b, changed);
    top_end_depth = pick(top_end_depth, end_depth, changed);
    top_clearance = pick(top_clearance, clearance, changed);
    top_id = pick(top_id, id, changed);
}

#include "lib/exact_points.glsl"

// `solid`: points that are inside of shapes, or none. With lanes a point is done in one dispatch.
void solve(int tile_index, bools solid) {
    int s = kExactLanes > 1 ? lane() : sectors_done();
    if (kExactLanes == 1 && s >= params.sectors) return;
    sum_r = reals(0.0);
    sum_g = reals(0.0);
    sum_b = reals(0.0);
    slope_x_r = reals(0.0);
    slope_x_g = reals(0.0);
    slope_x_b = reals(0.0);
    slope_y_r = reals(0.0);
    slope_y_g = reals(0.0);
    slope_y_b = reals(0.0);
    third = reals(0.0);
    signature = uints(0u);
    if (kExactLanes == 1 && params.continues != 0) load();
    int budget = kBudget;
    int list = tile_index * params.sectors;
    bool spent = false;
    if (all_of(solid)) s = params.sectors;
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
            now = reals(-params.tan_half);
            reals limit = reals(params.tan_half);
            if (kSky == 0) {
                int last_straight = first_straight + int(head.y >> 16);
                int last_disc = first_disc + int(head.z >> 16);
                int last_arc = first_arc + 2 * int((head.w >> 8) & 0xffu);
                int last_ellipse = first_ellipse + 4 * int(head.w >> 24);
                light_start = reals(kFar);
                light_end = reals(-kFar);
                budget -= 5 + last_straight - first_straight + last_disc - first_disc + last_arc - first_arc + last_ellipse - first_ellipse;
                for (int i = first_straight; i < last_straight; ++i) shine(straight_at(i, reals(0.0)));
                for (int i = first_disc; i < last_disc; ++i) shine(disc_at(i, reals(0.0)));
                if (kArcs != 0) for (int i = first_arc; i < last_arc; i += 2) shine(arc_at(i, reals(0.0)));
                if (kEllipses != 0) for (int i = first_ellipse; i < last_ellipse; i += 4) shine(ellipse_at(i, reals(0.0)));
                now = max(now, light_start - 2.0 * kLookAhead);
                limit = min(limit, light_end + 2.0 * kLookAhead);
            }
            from = now;
            top = reals(kUnknown);
            top_end = reals(-kFar);
            top_far = reals(1.0);
            top_end_depth = reals(1.0);
            top_clearance = reals(kFar);
            top_r = reals(0.0);
            top_g = reals(0.0);
            top_b = reals(0.0);
            top_id = uints(0u);
            bools idle = solid;
            // What lies behind a surface does not light it.
            if (kNodes != 0) idle = lt(normal_x * axis.x + normal_y * axis.y, reals(-params.tan_half));
            now = pick(now, limit, idle);
            while (any_of(lt(now, limit)) && budget > 0) {
                reals ahead = now + kLookAhead;
                next = limit;
                nearest = reals(kFar);
                near_entry = reals(kNone);
                // What was nearest hides as long as it goes on.
                near_end = pick(reals(-kFar), top_end, gt(top_end, now));
                near_far = top_far;
                budget -= 5 + end_entry - first_straight + (kSurfaces != 0 ? 8 : 0);
                consider_straights(ahead);
                for (int i = first_disc; i < first_arc; ++i) consider(i, disc_at(i, ahead));
                if (kArcs != 0) for (int i = first_arc; i < first_ellipse; i += 2) consider(i, arc_at(i, ahead));
                if (kEllipses != 0) for (int i = first_ellipse; i < end_entry; i += 4) consider(i, ellipse_at(i, ahead));
                bools found = ge(near_entry, reals(0.0));
                next = pick(next, min(next, near_end), found);
                bools changed = both(ne(near_entry, top), lt(now, limit));
                if (EXACT_WIDTH > 1 || any_of(changed)) change(changed, sector.z);
                top_end = pick(reals(-kFar), near_end, found);
                top_far = near_far;
                now = next;
            }
            // A walk that takes more than a whole budget is cut off, and the host told.
            spent = spent || (budget <= 0 && any_of(lt(now, limit)));
            gather(bools(true), max(now, from), sector.z);
            if (kSky == 0 && kSlopes != 0) {
                bools counts = both(lt(limit, reals(params.tan_half)), ne(top, reals(kUnknown)));
                uints pair = top_id * 0x85ebca6bu;
                signature += pick(uints(0u), mixed(pair), counts);
            }
        }
    }
    if (spent) atomicAdd(told[kExactToldSpent], 1u);
    if (kExactLanes > 1) s = params.sectors;
    else if (s < params.sectors) atomicAdd(told[kExactToldUnfinished], 1u);
    store(s);
}

void main() {
    int index = job_index();
    int count = kNodes != 0 ? params.jobs : int(counters[kExactCountLevel + 4 * params.level]);
    bool without_job = index >= count;
    if (kExactLanes == 1 && without_job) return;
    if (without_job) index = 0;
    uint job = texelFetch(jobs, index).r;
    int tile = int(job & 0xffffffu);
    bools solid = bools(false);
    if (kNodes != 0) find_nodes(4 * index);
    else solid = find_points(tile, 4 * int(job >> 24), int(counters[params.first_count + tile]));
    if (without_job) {
        // Its threads must meet those of other points.
        leave_out();
        solid = bools(true);
    }
    solve(tile, solid);
}
