// Pieces of outline seen from points: from where to where, and how deep. Reads `entries` of the program that includes it.

const float kFar = 1e30;
const float kBehind = 1e9;  // key of what lies behind

#include "lib/pick.glsl"
#include "lib/exact_width.glsl"

reals px, py;
vec2 axis, side;

// A piece seen from the points: keys and depths of its ends towards growing angles, its depth at the key `ahead`, and how
// near the curve comes that its ends move on.
struct Span {
    bools seen;
    reals start, end, start_depth, end_depth, depth, clearance;
};

// From the ends as vectors from the points.
void set_ends(inout Span span, bools faces, reals sx, reals sy, reals ex, reals ey) {
    span.start_depth = axis.x * sx + axis.y * sy;
    span.end_depth = axis.x * ex + axis.y * ey;
    span.start = pick(reals(-kBehind), (side.x * sx + side.y * sy) / span.start_depth, gt(span.start_depth, reals(0.0)));
    span.end = pick(reals(kBehind), (side.x * ex + side.y * ey) / span.end_depth, gt(span.end_depth, reals(0.0)));
    span.seen = both(faces, gt(max(span.start_depth, span.end_depth), reals(0.0)));
}

Span straight_span(reals x0, reals y0, reals x1, reals y1, reals ahead) {
    Span span;
    reals ax = x0 - px, ay = y0 - py;
    reals ex = x1 - x0, ey = y1 - y0;
    reals rise = ax * ey - ay * ex;
    set_ends(span, lt(rise, reals(0.0)), x1 - px, y1 - py, ax, ay);
    reals wx = axis.x + side.x * ahead, wy = axis.y + side.y * ahead;
    span.depth = rise / min(wx * ey - wy * ex, reals(-1e-30));
    span.clearance = reals(kFar);
    return span;
}

// A circle seen from outside: rays touch it in the directions of v, to its centre, turned by the angle of sine r / |v|
// either way, at the distance t.
Span round_span(reals vx, reals vy, reals radius, reals ahead, out reals sx, out reals sy, out reals ex, out reals ey) {
    Span span;
    reals d2 = vx * vx + vy * vy;
    reals rise = d2 - radius * radius;
    reals t = sqrt(max(rise, reals(0.0)));
    reals k = t / max(d2, reals(1e-30));
    reals tk = t * k;
    reals rk = radius * k;
    sx = vx * tk + vy * rk;
    sy = vy * tk - vx * rk;
    ex = vx * tk - vy * rk;
    ey = vy * tk + vx * rk;
    reals wx = axis.x + side.x * ahead, wy = axis.y + side.y * ahead;
    reals b = vx * wx + vy * wy;
    span.depth = rise / max(b + sqrt(max(b * b - (1.0 + ahead * ahead) * rise, reals(0.0))), reals(1e-30));
    span.clearance = sqrt(d2) - radius;
    span.seen = gt(rise, reals(0.0));
    return span;
}

Span disc_span(reals cx, reals cy, reals radius, reals ahead) {
    reals sx, sy, ex, ey;
    Span span = round_span(cx - px, cy - py, radius, ahead, sx, sy, ex, ey);
    bools outside = span.seen;
    set_ends(span, outside, sx, sy, ex, ey);
    return span;
}

Span arc_span(reals cx, reals cy, reals radius, reals x0, reals y0, reals x1, reals y1, reals ahead) {
    reals sx, sy, ex, ey;
    reals vx = cx - px, vy = cy - py;
    Span span = round_span(vx, vy, radius, ahead, sx, sy, ex, ey);
    reals ax = x0 - cx, ay = y0 - cy, bx = x1 - cx, by = y1 - cy;  // from the centre
    bools front_a = lt(ax * (x0 - px) + ay * (y0 - py), reals(0.0));
    bools front_b = lt(bx * (x1 - px) + by * (y1 - py), reals(0.0));
    // With both ends behind the horizon the arc shows its middle, or nothing.
    bools within = both(lt(ax * vy - ay * vx, reals(0.0)), lt(vx * by - vy * bx, reals(0.0)));
    bools shows = both(span.seen, either(within, either(front_a, front_b)));
    set_ends(span, shows, pick(sx, x1 - px, front_b), pick(sy, y1 - py, front_b), pick(ex, x0 - px, front_a),
             pick(ey, y0 - py, front_a));
    return span;
}

// head, frame, ends and back are the four texels of the entry.
Span ellipse_span(vec4 head, vec4 frame, vec4 ends, vec4 back, reals ahead) {
    Span span;
    // In the frame where the ellipse is the unit circle.
    reals fx = px - head.x, fy = py - head.y;
    reals qx = frame.x * fx + frame.y * fy;
    reals qy = frame.z * fx + frame.w * fy;
    reals norm = qx * qx + qy * qy;
    reals rise = norm - 1.0;
    reals t = sqrt(max(rise, reals(0.0)));
    reals k = 1.0 / max(norm, reals(1e-30));
    reals hx = (qx - qy * t) * k, hy = (qy + qx * t) * k;  // touching points, of larger and smaller parameter
    reals lx = (qx + qy * t) * k, ly = (qy - qx * t) * k;
    reals sx = back.x * hx + back.z * hy - fx, sy = back.y * hx + back.w * hy - fy;
    reals ex = back.x * lx + back.z * ly - fx, ey = back.y * lx + back.w * ly - fy;
    vec2 a = ends.xy - head.xy;
    vec2 b = ends.zw - head.xy;
    vec2 ea = vec2(dot(frame.xy, a), dot(frame.zw, a));
    vec2 eb = vec2(dot(frame.xy, b), dot(frame.zw, b));
    bools part = bools(head.w == 0.0);
    bools front_a = both(part, gt(ea.x * qx + ea.y * qy, reals(1.0)));
    bools front_b = both(part, gt(eb.x * qx + eb.y * qy, reals(1.0)));
    bools within = both(gt(ea.x * qy - ea.y * qx, reals(0.0)), gt(qx * eb.y - qy * eb.x, reals(0.0)));
    bools shows = either(opposite(part), either(within, either(front_a, front_b)));
    set_ends(span, both(shows, gt(rise, reals(0.0))), pick(sx, ends.z - px, front_b), pick(sy, ends.w - py, front_b),
             pick(ex, ends.x - px, front_a), pick(ey, ends.y - py, front_a));
    reals dx = axis.x + side.x * ahead, dy = axis.y + side.y * ahead;
    reals wx = frame.x * dx + frame.y * dy;
    reals wy = frame.z * dx + frame.w * dy;
    reals beta = -(qx * wx + qy * wy);
    span.depth = rise / max(beta + sqrt(max(beta * beta - (wx * wx + wy * wy) * rise, reals(0.0))), reals(1e-30));
    span.clearance = (sqrt(norm) - 1.0) * min(length(back.xy), length(back.zw));
    return span;
}

Span straight_at(int entry, reals ahead) {
    vec4 e = texelFetch(entries, entry);
    return straight_span(reals(e.x), reals(e.y), reals(e.z), reals(e.w), ahead);
}

Span disc_at(int entry, reals ahead) {
    vec4 e = texelFetch(entries, entry);
    return disc_span(reals(e.x), reals(e.y), reals(e.z), ahead);
}

Span arc_at(int entry, reals ahead) {
    vec4 e = texelFetch(entries, entry);
    vec4 ends = texelFetch(entries, entry + 1);
    return arc_span(reals(e.x), reals(e.y), reals(e.z), reals(ends.x), reals(ends.y), reals(ends.z), reals(ends.w), ahead);
}

Span ellipse_at(int entry, reals ahead) {
    return ellipse_span(texelFetch(entries, entry), texelFetch(entries, entry + 1), texelFetch(entries, entry + 2),
                        texelFetch(entries, entry + 3), ahead);
}

// Each point's own.
Span ellipses_at(ints entry, reals ahead) {
#if EXACT_WIDTH == 4
    Span o0 = ellipse_at(entry.x, ahead), o1 = ellipse_at(entry.y, ahead), o2 = ellipse_at(entry.z, ahead), o3 = ellipse_at(entry.w, ahead);
    Span span = o0;
    span.start = vec4(o0.start.x, o1.start.y, o2.start.z, o3.start.w);
    span.start_depth = vec4(o0.start_depth.x, o1.start_depth.y, o2.start_depth.z, o3.start_depth.w);
    span.end_depth = vec4(o0.end_depth.x, o1.end_depth.y, o2.end_depth.z, o3.end_depth.w);
    span.clearance = vec4(o0.clearance.x, o1.clearance.y, o2.clearance.z, o3.clearance.w);
    return span;
#else
    return ellipse_at(entry, ahead);
#endif
}

// Of |x| <= 1, to 2e-8: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49. Mesa's own is 2e-5 too small near 0.
reals arctangent(reals x) {
    reals z = x * x;
    reals sum = 0.0028662257 * z - 0.0161657367;
    sum = sum * z + 0.0429096138;
    sum = sum * z - 0.0752896400;
    sum = sum * z + 0.1065626393;
    sum = sum * z - 0.1420889944;
    sum = sum * z + 0.1999355085;
    sum = sum * z - 0.3333314528;
    return x + x * z * sum;
}
