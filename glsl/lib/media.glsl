// Translucent shapes: what a ray loses and gains on its way through them (Beer and Lambert), from crossing to crossing.
#include "lib/scene.glsl"

layout(binding = kMediaUnit) uniform samplerBuffer media;

// Which program this is: whether the scene has any.
const int kSceneMedia = 0;

// What is thinner than this (px) along a ray is stepped over.
const float kMediumSkip = 1e-3;

// Where a line is inside: from x to y along it, or nothing (x > y).
vec2 line_in_circle(vec2 p, vec2 d, float r) {
    float along = -dot(p, d);
    vec2 foot = p + along * d;
    float room = r * r - dot(foot, foot);
    float half_chord = sqrt(max(room, 0.0));
    return room > 0.0 ? vec2(along - half_chord, along + half_chord) : vec2(kFar, -kFar);
}

vec2 line_in_box(vec2 p, vec2 d, vec2 half_size) {
    vec2 a = (-half_size - p) / d;
    vec2 b = (half_size - p) / d;
    vec2 lo = min(a, b);
    vec2 hi = max(a, b);
    if (d.x == 0.0) { hi.x = abs(p.x) <= half_size.x ? kFar : -kFar; lo.x = -hi.x; }
    if (d.y == 0.0) { hi.y = abs(p.y) <= half_size.y ? kFar : -kFar; lo.y = -hi.y; }
    vec2 within = vec2(max(lo.x, lo.y), min(hi.x, hi.y));
    return within.x < within.y ? within : vec2(kFar, -kFar);
}

// Of parts of one convex shape.
vec2 both_parts(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

vec2 line_in_rect(vec2 p, vec2 d, vec2 half_size, float corner) {
    if (corner <= 0.0) return line_in_box(p, d, half_size);
    vec2 inner = half_size - corner;
    vec2 other = vec2(inner.x, -inner.y);
    vec2 part = both_parts(line_in_box(p, d, vec2(half_size.x, inner.y)), line_in_box(p, d, vec2(inner.x, half_size.y)));
    part = both_parts(part, both_parts(line_in_circle(p - inner, d, corner), line_in_circle(p + inner, d, corner)));
    return both_parts(part, both_parts(line_in_circle(p - other, d, corner), line_in_circle(p + other, d, corner)));
}

vec2 line_in_capsule(vec2 p, vec2 d, vec4 edge, float half_width) {
    vec2 part = both_parts(line_in_circle(p - edge.xy, d, half_width), line_in_circle(p - edge.zw, d, half_width));
    vec2 along = edge.zw - edge.xy;
    float size = length(along);
    if (size == 0.0) return part;
    vec2 axis = along / size;
    return both_parts(part, line_in_box(rotate_into(p - 0.5 * (edge.xy + edge.zw), axis), rotate_into(d, axis), vec2(0.5 * size, half_width)));
}

// The next crossing of an outline after `at` (at most `next`), and whether the place at `at` is inside.
void ask_part(vec2 part, float at, inout float next, inout bool inside) {
    if (part.x > at) next = min(next, part.x);
    else if (part.y > at) {
        next = min(next, part.y);
        inside = true;
    }
}

bool ask_medium(int shape, vec2 p, vec2 d, float at, inout float next) {
    int record = shape * kShapeTexels;
    vec4 head = texelFetch(shape_records, record);
    vec4 a = texelFetch(shape_records, record + 2);
    vec4 b = texelFetch(shape_records, record + 3);
    int type = int(head.x);
    bool inside = false;
    vec2 part = vec2(kFar, -kFar);
    if (type == kShapeCircle) part = line_in_circle(p - a.xy, d, a.z);
    if (type == kShapeRect) part = line_in_rect(rotate_into(p - a.xy, b.xy), rotate_into(d, b.xy), a.zw, b.z);
    if (type == kShapeLine) part = line_in_capsule(p, d, a, b.z);
    if (kSceneEllipses != 0 && type == kShapeEllipse) {
        vec2 e = rotate_into(d, b.xy) / a.zw;
        float size = length(e);
        part = line_in_circle(rotate_into(p - a.xy, b.xy) / a.zw, e / size, 1.0);
        if (part.x < part.y) part /= size;
    }
    ask_part(part, at, next, inside);
    if (kSceneOutlines != 0) {
        int first = int(head.z);
        int end = first + int(head.w);
        for (int i = first; i < end; ++i) {
            vec4 edge = texelFetch(edges, i);
            if (type == kShapePolyline) {
                ask_part(line_in_capsule(p, d, edge, b.z), at, next, inside);
            } else {
                // By sides of the line, so that two edges that share a vertex leave no gap; inside by the even-odd rule.
                vec2 u = edge.xy - p;
                vec2 v = edge.zw - p;
                float side_u = d.x * u.y - d.y * u.x;
                float side_v = d.x * v.y - d.y * v.x;
                if ((side_u > 0.0) != (side_v > 0.0)) {
                    float t = dot(u, d) + (dot(v, d) - dot(u, d)) * (side_u / (side_u - side_v));
                    if (t > at) {
                        next = min(next, t);
                        inside = !inside;
                    }
                }
            }
        }
    }
    return inside;
}

// From `from` to `to` along the ray: radiance gained on the way, and the share of what comes from its end that arrives. The
// topmost medium counts. Spends of the invocation's loop iterations; false when they ran out.
bool cross_media(vec2 p, vec2 d, float from, float to, inout int budget, out vec3 gained, out vec3 through) {
    gained = vec3(0.0);
    through = vec3(1.0);
    vec4 head = texelFetch(media, 0);
    vec4 box = texelFetch(media, 1);
    int first = int(head.x);
    int count = int(head.y);
    int cost = int(head.z) + 1;
    vec2 within = line_in_box(p - 0.5 * (box.xy + box.zw), d, 0.5 * (box.zw - box.xy));
    float t = max(from, within.x);
    float end = min(to, within.y);
    while (t < end && budget > 0) {
        budget -= cost;
        float at = t + kMediumSkip;
        float next = end;
        int top = -1;
        for (int i = 0; i < count; ++i)
            if (ask_medium(first + i, p, d, at, next)) top = i;
        next = max(next, min(at, end));
        if (top >= 0) {
            float size = next - t;
            vec3 extinction = texelFetch(shape_records, (first + top) * kShapeTexels + 1).rgb;
            vec3 emission = texelFetch(media, 2 + 2 * top).rgb;
            vec3 depth = extinction * size;
            vec3 passes = exp(-depth);
            // (1 - exp(-depth)) / extinction; its series where the difference would lose its digits.
            vec3 gain = pick((1.0 - passes) / max(extinction, vec3(1e-30)), size * (1.0 - depth * (0.5 - depth * (1.0 / 6.0))), lessThan(depth, vec3(0.03)));
            gained += through * emission * gain;
            through *= passes;
        }
        t = next;
    }
    return t >= end;
}

// Whether a ray may come through a medium on its way to p + far.
bool may_cross_media(vec2 p, vec2 far) {
    if (kSceneMedia == 0) return false;
    vec4 box = texelFetch(media, 1);
    vec2 lo = min(p, p + far), hi = max(p, p + far);
    return all(lessThanEqual(lo, box.zw)) && all(greaterThanEqual(hi, box.xy));
}
