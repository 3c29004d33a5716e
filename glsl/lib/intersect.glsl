// Exact intersection of rays with shapes: the distance at which a ray that starts outside first enters,
// kFar when it does not. Directions have length 1.
#include "lib/scene.glsl"

// The foot of the perpendicular first: no cancellation when the circle is far or small.
float enter_circle(vec2 p, vec2 d, float r) {
    float along = -dot(p, d);
    vec2 foot = p + along * d;
    float room = r * r - dot(foot, foot);
    if (room < 0.0) return kFar;
    float t = along - sqrt(room);
    return t >= 0.0 ? t : kFar;
}

float enter_box(vec2 p, vec2 d, vec2 half_size) {
    vec2 a = (-half_size - p) / d;
    vec2 b = (half_size - p) / d;
    vec2 lo = min(a, b);
    vec2 hi = max(a, b);
    // Along an axis the ray stays between two sides, or outside of them.
    if (d.x == 0.0) { hi.x = abs(p.x) <= half_size.x ? kFar : -kFar; lo.x = -hi.x; }
    if (d.y == 0.0) { hi.y = abs(p.y) <= half_size.y ? kFar : -kFar; lo.y = -hi.y; }
    float enter = max(lo.x, lo.y);
    float leave = min(hi.x, hi.y);
    return enter <= leave && enter >= 0.0 ? enter : kFar;
}

float enter_rounded_box(vec2 p, vec2 d, vec2 half_size, float corner) {
    if (corner <= 0.0) return enter_box(p, d, half_size);
    vec2 inner = half_size - corner;
    float t = min(enter_box(p, d, vec2(half_size.x, inner.y)), enter_box(p, d, vec2(inner.x, half_size.y)));
    t = min(t, min(enter_circle(p - inner, d, corner), enter_circle(p + inner, d, corner)));
    vec2 other = vec2(inner.x, -inner.y);
    return min(t, min(enter_circle(p - other, d, corner), enter_circle(p + other, d, corner)));
}

float enter_capsule(vec2 p, vec2 d, vec4 edge, float half_width) {
    float t = min(enter_circle(p - edge.xy, d, half_width), enter_circle(p - edge.zw, d, half_width));
    vec2 along = edge.zw - edge.xy;
    float size = length(along);
    if (size == 0.0) return t;
    vec2 axis = along / size;
    return min(t, enter_box(rotate_into(p - 0.5 * (edge.xy + edge.zw), axis), rotate_into(d, axis), vec2(0.5 * size, half_width)));
}

float enter_ellipse(vec2 p, vec2 d, vec2 r) {
    vec2 q = p / r;
    vec2 e = d / r;
    float size = length(e);
    float t = enter_circle(q, e / size, 1.0);
    return t >= kFar ? kFar : t / size;
}

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

float enter_edge(vec2 p, vec2 d, vec4 edge) {
    vec2 a = edge.xy - p;
    vec2 b = edge.zw - p;
    // By sides of the ray's line: two edges that share a vertex leave no gap.
    if ((cross2(d, a) > 0.0) == (cross2(d, b) > 0.0)) return kFar;
    float t = cross2(a, b - a) / cross2(d, b - a);
    return t >= 0.0 ? t : kFar;
}

// Texel by texel (Amanatides and Woo, 1987).
float enter_bitmap(vec2 p, vec2 d, vec4 box, vec4 image) {
    vec2 size = image.yz;
    vec2 scale = size / box.zw;
    vec2 q = (p - box.xy) * scale;
    vec2 e = d * scale;
    vec2 lo = (vec2(0.0) - q) / e;
    vec2 hi = (size - q) / e;
    if (e.x == 0.0) { lo.x = q.x >= 0.0 && q.x <= size.x ? -kFar : kFar; hi.x = -lo.x; }
    if (e.y == 0.0) { lo.y = q.y >= 0.0 && q.y <= size.y ? -kFar : kFar; hi.y = -lo.y; }
    float t = max(max(min(lo.x, hi.x), min(lo.y, hi.y)), 0.0);
    float leave = min(max(lo.x, hi.x), max(lo.y, hi.y));
    if (t >= leave) return kFar;
    ivec2 texel = clamp(ivec2(floor(q + e * t)), ivec2(0), ivec2(size) - 1);
    ivec2 move = ivec2(sign(e));
    vec2 delta = vec2(e.x == 0.0 ? kFar : abs(1.0 / e.x), e.y == 0.0 ? kFar : abs(1.0 / e.y));
    vec2 border = vec2(texel) + vec2(move.x > 0 ? 1.0 : 0.0, move.y > 0 ? 1.0 : 0.0);
    vec2 next = vec2(e.x == 0.0 ? kFar : (border.x - q.x) / e.x, e.y == 0.0 ? kFar : (border.y - q.y) / e.y);
    int steps = int(size.x) + int(size.y) + 2;
    for (int i = 0; i < steps; ++i) {
        if (texelFetch(bitmap_texels, int(image.x) + texel.y * int(size.x) + texel.x).a >= image.w) return t;
        bool along_x = next.x < next.y;
        t = along_x ? next.x : next.y;
        if (along_x) { texel.x += move.x; next.x += delta.x; } else { texel.y += move.y; next.y += delta.y; }
        if (texel.x < 0 || texel.y < 0 || texel.x >= int(size.x) || texel.y >= int(size.y)) return kFar;
    }
    return kFar;
}

float enter_shape(int shape, vec2 p, vec2 d) {
    int at = shape * kShapeTexels;
    vec4 head = texelFetch(shape_records, at);
    vec4 a = texelFetch(shape_records, at + 2);
    vec4 b = texelFetch(shape_records, at + 3);
    int type = int(head.x);
    if (type == kShapeCircle) return enter_circle(p - a.xy, d, a.z);
    if (type == kShapeRect) return enter_rounded_box(rotate_into(p - a.xy, b.xy), rotate_into(d, b.xy), a.zw, b.z);
    if (type == kShapeLine) return enter_capsule(p, d, a, b.z);
    if (type == kShapeEllipse) return enter_ellipse(rotate_into(p - a.xy, b.xy), rotate_into(d, b.xy), a.zw);
    if (type == kShapeBitmap) return enter_bitmap(p, d, a, b);
    int first = int(head.z);
    int end = first + int(head.w);
    // A ray that misses the box misses the outline; one that starts in it is asked edge by edge.
    vec2 middle = 0.5 * (a.xy + a.zw);
    vec2 half_box = 0.5 * (a.zw - a.xy) + b.z + 1e-3;
    bool within = all(lessThanEqual(abs(p - middle), half_box));
    if (!within && enter_box(p - middle, d, half_box) >= kFar) return kFar;
    float t = kFar;
    for (int i = first; i < end; ++i) {
        vec4 e = texelFetch(edges, i);
        t = min(t, type == kShapePolyline ? enter_capsule(p, d, e, b.z) : enter_edge(p, d, e));
    }
    return t;
}

// The first shape that a ray from free space meets, -1 for none; where two begin at one place, the topmost.
int first_hit(vec2 p, vec2 d, int shape_count, out float nearest) {
    nearest = kFar;
    int hit = -1;
    for (int i = 0; i < shape_count; ++i) {
        float t = enter_shape(i, p, d);
        if (t < kFar && t <= nearest) {
            nearest = t;
            hit = i;
        }
    }
    return hit;
}
