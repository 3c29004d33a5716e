// Pieces of outline seen from points: from where to where, and how deep. Reads `entries` of the program that includes it, four
// points a thread.

const float kFar = 1e30;
const float kBehind = 1e9;  // key of what lies behind

// Four points at once, in the four components of every vector: one fetch of a piece serves four, and their arithmetic
// overlaps.
bvec4 both(bvec4 a, bvec4 b) { return bvec4(a.x && b.x, a.y && b.y, a.z && b.z, a.w && b.w); }
bvec4 either(bvec4 a, bvec4 b) { return bvec4(a.x || b.x, a.y || b.y, a.z || b.z, a.w || b.w); }

#include "lib/pick.glsl"

vec4 px, py;
vec2 axis, side;

// A piece seen from the points: keys and depths of its ends towards growing angles, its depth at the key `ahead`, and how
// near the curve comes that its ends move on.
struct Span {
    bvec4 seen;
    vec4 start, end, start_depth, end_depth, depth, clearance;
};

// From the ends as vectors from the points.
void set_ends(inout Span span, bvec4 faces, vec4 sx, vec4 sy, vec4 ex, vec4 ey) {
    span.start_depth = axis.x * sx + axis.y * sy;
    span.end_depth = axis.x * ex + axis.y * ey;
    span.start = pick(vec4(-kBehind), (side.x * sx + side.y * sy) / span.start_depth, greaterThan(span.start_depth, vec4(0.0)));
    span.end = pick(vec4(kBehind), (side.x * ex + side.y * ey) / span.end_depth, greaterThan(span.end_depth, vec4(0.0)));
    span.seen = both(faces, greaterThan(max(span.start_depth, span.end_depth), vec4(0.0)));
}

Span straight_span(vec4 x0, vec4 y0, vec4 x1, vec4 y1, vec4 ahead) {
    Span span;
    vec4 ax = x0 - px, ay = y0 - py;
    vec4 ex = x1 - x0, ey = y1 - y0;
    vec4 rise = ax * ey - ay * ex;
    set_ends(span, lessThan(rise, vec4(0.0)), x1 - px, y1 - py, ax, ay);
    vec4 wx = axis.x + side.x * ahead, wy = axis.y + side.y * ahead;
    span.depth = rise / min(wx * ey - wy * ex, vec4(-1e-30));
    span.clearance = vec4(kFar);
    return span;
}

// A circle seen from outside: rays touch it in the directions of v, to its centre, turned by the angle of sine r / |v|
// either way, at the distance t.
Span round_span(vec4 vx, vec4 vy, vec4 radius, vec4 ahead, out vec4 sx, out vec4 sy, out vec4 ex, out vec4 ey) {
    Span span;
    vec4 d2 = vx * vx + vy * vy;
    vec4 rise = d2 - radius * radius;
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
    span.depth = rise / max(b + sqrt(max(b * b - (1.0 + ahead * ahead) * rise, vec4(0.0))), vec4(1e-30));
    span.clearance = sqrt(d2) - radius;
    span.seen = greaterThan(rise, vec4(0.0));
    return span;
}

Span disc_span(vec4 cx, vec4 cy, vec4 radius, vec4 ahead) {
    vec4 sx, sy, ex, ey;
    Span span = round_span(cx - px, cy - py, radius, ahead, sx, sy, ex, ey);
    bvec4 outside = span.seen;
    set_ends(span, outside, sx, sy, ex, ey);
    return span;
}

Span arc_span(vec4 cx, vec4 cy, vec4 radius, vec4 x0, vec4 y0, vec4 x1, vec4 y1, vec4 ahead) {
    vec4 sx, sy, ex, ey;
    vec4 vx = cx - px, vy = cy - py;
    Span span = round_span(vx, vy, radius, ahead, sx, sy, ex, ey);
    vec4 ax = x0 - cx, ay = y0 - cy, bx = x1 - cx, by = y1 - cy;  // from the centre
    bvec4 front_a = lessThan(ax * (x0 - px) + ay * (y0 - py), vec4(0.0));
    bvec4 front_b = lessThan(bx * (x1 - px) + by * (y1 - py), vec4(0.0));
    // With both ends behind the horizon the arc shows its middle, or nothing.
    bvec4 within = both(lessThan(ax * vy - ay * vx, vec4(0.0)), lessThan(vx * by - vy * bx, vec4(0.0)));
    bvec4 shows = both(span.seen, either(within, either(front_a, front_b)));
    set_ends(span, shows, pick(sx, x1 - px, front_b), pick(sy, y1 - py, front_b), pick(ex, x0 - px, front_a),
             pick(ey, y0 - py, front_a));
    return span;
}

// head, frame, ends and back are the four texels of the entry.
Span ellipse_span(vec4 head, vec4 frame, vec4 ends, vec4 back, vec4 ahead) {
    Span span;
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
    set_ends(span, both(shows, greaterThan(rise, vec4(0.0))), pick(sx, ends.z - px, front_b), pick(sy, ends.w - py, front_b),
             pick(ex, ends.x - px, front_a), pick(ey, ends.y - py, front_a));
    vec4 dx = axis.x + side.x * ahead, dy = axis.y + side.y * ahead;
    vec4 wx = frame.x * dx + frame.y * dy;
    vec4 wy = frame.z * dx + frame.w * dy;
    vec4 beta = -(qx * wx + qy * wy);
    span.depth = rise / max(beta + sqrt(max(beta * beta - (wx * wx + wy * wy) * rise, vec4(0.0))), vec4(1e-30));
    span.clearance = (sqrt(norm) - 1.0) * min(length(back.xy), length(back.zw));
    return span;
}

Span straight_at(int entry, vec4 ahead) {
    vec4 e = texelFetch(entries, entry);
    return straight_span(vec4(e.x), vec4(e.y), vec4(e.z), vec4(e.w), ahead);
}

Span disc_at(int entry, vec4 ahead) {
    vec4 e = texelFetch(entries, entry);
    return disc_span(vec4(e.x), vec4(e.y), vec4(e.z), ahead);
}

Span arc_at(int entry, vec4 ahead) {
    vec4 e = texelFetch(entries, entry);
    vec4 ends = texelFetch(entries, entry + 1);
    return arc_span(vec4(e.x), vec4(e.y), vec4(e.z), vec4(ends.x), vec4(ends.y), vec4(ends.z), vec4(ends.w), ahead);
}

Span ellipse_at(int entry, vec4 ahead) {
    return ellipse_span(texelFetch(entries, entry), texelFetch(entries, entry + 1), texelFetch(entries, entry + 2),
                        texelFetch(entries, entry + 3), ahead);
}

// Of |x| <= 1, to 2e-8: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49. Mesa's own is 2e-5 too small near 0.
vec4 arctangent(vec4 x) {
    vec4 z = x * x;
    vec4 sum = 0.0028662257 * z - 0.0161657367;
    sum = sum * z + 0.0429096138;
    sum = sum * z - 0.0752896400;
    sum = sum * z + 0.1065626393;
    sum = sum * z - 0.1420889944;
    sum = sum * z + 0.1999355085;
    sum = sum * z - 0.3333314528;
    return x + x * z * sum;
}
