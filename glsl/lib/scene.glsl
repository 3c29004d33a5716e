// The packed scene as functions: signed distance, membership, emission.
#include "scene_records.h"
#include "lib/pick.glsl"

layout(binding = kShapeRecordsUnit) uniform samplerBuffer shape_records;
layout(binding = kEdgesUnit) uniform samplerBuffer edges;
layout(binding = kBitmapTexelsUnit) uniform samplerBuffer bitmap_texels;

// Which program this is: a kind that the scene has not is left out.
const int kSceneEllipses = 1;
const int kSceneOutlines = 1;  // polylines and polygons
const int kSceneBitmaps = 1;
const int kSceneGradients = 1;  // of emission, along strokes

const float kFar = 1e30;

vec2 rotate_into(vec2 p, vec2 cos_sin) {
    return vec2(cos_sin.x * p.x + cos_sin.y * p.y, cos_sin.x * p.y - cos_sin.y * p.x);
}

float segment_distance(vec2 p, vec4 edge) {
    vec2 along = edge.zw - edge.xy;
    vec2 from = p - edge.xy;
    float h = clamp(dot(from, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    return length(from - along * h);
}

// Distance to an ellipse centred at the origin, semi-axes r: the root of Eberly's equation ("Distance
// from a Point to an Ellipse", geometrictools.com) by Newton's method. Its F is convex and falls, and the
// start lies left of the root with F in [0, 1], so the steps never pass the root.
float ellipse_distance(vec2 p, vec2 r) {
    p = abs(p);
    if (r.x < r.y) { p = p.yx; r = r.yx; }
    vec2 z = p / r;
    float ratio = (r.x / r.y) * (r.x / r.y);
    float inside = dot(z, z) - 1.0;
    float t = max(z.y - 1.0, ratio * (z.x - 1.0));
    // On the long axis inside the evolute the nearest point is off the axis.
    if (z.y < 1e-6 && p.x * r.x < (r.x - r.y) * (r.x + r.y)) {
        float x = p.x * r.x / ((r.x - r.y) * (r.x + r.y));
        vec2 q = vec2(r.x * x, r.y * sqrt(max(1.0 - x * x, 0.0)));
        return -length(q - p);
    }
    for (int i = 0; i < kEllipseIterations; ++i) {
        vec2 d = vec2(t + ratio, t + 1.0);
        vec2 a = vec2(ratio * z.x, z.y) / max(d, vec2(1e-20));
        float f = dot(a, a) - 1.0;
        float slope = -2.0 * (a.x * a.x / max(d.x, 1e-20) + a.y * a.y / max(d.y, 1e-20));
        float next = t - f / min(slope, -1e-20);
        if (!(next > t)) break;
        t = next;
    }
    vec2 q = vec2(ratio * p.x / (t + ratio), p.y / max(t + 1.0, 1e-20));
    float d = length(q - p);
    return inside < 0.0 ? -d : d;
}

bool bitmap_texel(vec4 box, vec4 image, vec2 p, out int texel) {
    vec2 uv = (p - box.xy) / box.zw;
    texel = 0;
    if (uv.x < 0.0 || uv.y < 0.0 || uv.x >= 1.0 || uv.y >= 1.0) return false;
    ivec2 size = ivec2(image.yz);
    ivec2 at = min(ivec2(uv * vec2(size)), size - 1);
    texel = int(image.x) + at.y * size.x + at.x;
    return true;
}

// Signed distance (px) from p to a shape, negative inside. `best` is the smallest so far: what is
// surely farther may return any value that is farther.
float shape_distance(int shape, vec2 p, float best) {
    int at = shape * kShapeTexels;
    vec4 head = texelFetch(shape_records, at);
    vec4 a = texelFetch(shape_records, at + 2);
    vec4 b = texelFetch(shape_records, at + 3);
    int type = int(head.x);
    if (type == kShapeCircle) return length(p - a.xy) - a.z;
    if (type == kShapeRect) {
        vec2 q = abs(rotate_into(p - a.xy, b.xy)) - a.zw + b.z;
        return length(max(q, vec2(0.0))) + min(max(q.x, q.y), 0.0) - b.z;
    }
    if (kSceneEllipses + kSceneOutlines + kSceneBitmaps == 0 || type == kShapeLine) return segment_distance(p, a) - b.z;
    if (kSceneEllipses != 0 && type == kShapeEllipse) return ellipse_distance(rotate_into(p - a.xy, b.xy), a.zw);
    if (kSceneBitmaps != 0 && type == kShapeBitmap) {
        int texel;
        if (!bitmap_texel(a, b, p, texel)) return kFar;
        // Distances to a bitmap come from jump flooding; here only: is this pixel solid?
        return texelFetch(bitmap_texels, texel).a >= b.w ? -0.5 : kFar;
    }
    if (kSceneOutlines == 0) return kFar;
    int first = int(head.z);
    int end = first + int(head.w);
    vec2 outside = max(max(a.xy - p, p - a.zw), vec2(0.0));
    float box_distance = length(outside) - b.z;
    if (box_distance > max(best, 0.0)) return box_distance;
    float nearest = kFar;
    bool odd = false;
    for (int i = first; i < end; ++i) {
        vec4 e = texelFetch(edges, i);
        nearest = min(nearest, segment_distance(p, e));
        if ((e.y > p.y) != (e.w > p.y) && p.x < e.x + (p.y - e.y) * (e.z - e.x) / (e.w - e.y)) odd = !odd;
    }
    if (type == kShapePolyline) return nearest - b.z;
    return odd ? -nearest : nearest;
}

vec3 srgb_to_linear(vec3 c) {
    return pick(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// Share of an edge's length at which the point nearest to p lies.
float segment_share(vec2 p, vec4 edge) {
    vec2 along = edge.zw - edge.xy;
    return clamp(dot(p - edge.xy, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
}

// Emission of a stroke with a gradient at p.
vec3 gradient_emission(vec4 head, vec4 a, vec4 b, vec2 p) {
    float share;
    int first = int(b.y);
    if (int(head.x) == kShapeLine) {
        share = segment_share(p, a);
    } else {
        float nearest = kFar;
        int from = int(head.z);
        for (int i = 0; i < int(head.w); ++i) {
            vec4 e = texelFetch(edges, from + i);
            float d = segment_distance(p, e);
            vec4 shares = texelFetch(edges, first + i);
            if (d < nearest) share = mix(shares.x, shares.y, segment_share(p, e));
            nearest = min(nearest, d);
        }
        first += int(head.w);
    }
    vec4 last = texelFetch(edges, first);
    vec3 emission = last.rgb;
    for (int i = 1; i < int(b.x); ++i) {
        vec4 stop = texelFetch(edges, first + i);
        if (share >= last.a) emission = mix(last.rgb, stop.rgb, clamp((share - last.a) / max(stop.a - last.a, 1e-9), 0.0, 1.0));
        last = stop;
    }
    return emission;
}

// Emission of a shape at p, in the units of the packed scene.
vec3 shape_emission(int shape, vec2 p) {
    int at = shape * kShapeTexels;
    vec4 light = texelFetch(shape_records, at + 1);
    if (kSceneGradients != 0) {
        vec4 head = texelFetch(shape_records, at);
        vec4 b = texelFetch(shape_records, at + 3);
        if ((int(head.x) == kShapeLine || int(head.x) == kShapePolyline) && b.x > 0.0) return gradient_emission(head, texelFetch(shape_records, at + 2), b, p);
    }
    if (kSceneBitmaps == 0 || int(texelFetch(shape_records, at).x) != kShapeBitmap) return light.rgb;
    int texel;
    if (light.w == 0.0 ||
        !bitmap_texel(texelFetch(shape_records, at + 2), texelFetch(shape_records, at + 3), p, texel)) return vec3(0.0);
    return srgb_to_linear(texelFetch(bitmap_texels, texel).rgb) * light.w;
}
