// A sector of directions as one widening beam: what is narrower than the beam takes its share of it, where a ray as
// thin as a line would meet it or not.
#include "lib/march.glsl"
#include "lib/intersect.glsl"

// A convex shape seen along a beam through p: its shadow across the beam is an interval.
vec2 shape_shadow(int type, vec4 a, vec4 b, vec2 p, vec2 across) {
    vec2 turned = rotate_into(across, b.xy);
    vec2 middle = a.xy;
    float reach = a.z;  // circle
    if (type == kShapeEllipse) reach = length(turned * a.zw);
    if (type == kShapeRect) reach = dot(abs(turned), a.zw - b.z) + b.z;
    if (type == kShapeLine) {
        middle = 0.5 * (a.xy + a.zw);
        reach = 0.5 * abs(dot(a.zw - a.xy, across)) + b.z;
    }
    float c = dot(middle - p, across);
    return vec2(c - reach, c + reach);
}

// The share of a beam of width w along d through p that a convex shape covers. Negative for shapes that are not known to be
// convex.
float covered_share(int shape, int type, vec2 p, vec2 d, float w) {
    if (type == kShapePolyline || type == kShapePolygon || type == kShapeBitmap) return -1.0;
    vec4 a = texelFetch(shape_records, shape * kShapeTexels + 2);
    vec4 b = texelFetch(shape_records, shape * kShapeTexels + 3);
    vec2 shadow = shape_shadow(type, a, b, p, vec2(-d.y, d.x));
    return clamp((min(shadow.y, 0.5 * w) - max(shadow.x, -0.5 * w)) / w, 0.0, 1.0);
}

// What a shape shines with into a beam: where the middle of its share, seen along the beam, meets it.
vec3 beam_light(int shape, int type, vec2 at, vec2 d, float t, float w, ivec2 border, vec3 emission, inout int budget) {
    if (kSceneSurfaces == 0) return emission;
    vec4 a = texelFetch(shape_records, shape * kShapeTexels + 2);
    vec4 b = texelFetch(shape_records, shape * kShapeTexels + 3);
    vec2 across = vec2(-d.y, d.x);
    vec2 shadow = shape_shadow(type, a, b, at, across);
    vec2 start = at - t * d + 0.5 * (max(shadow.x, -0.5 * w) + min(shadow.y, 0.5 * w)) * across;
    float enters = kFar;
    if (type == kShapeCircle) enters = enter_circle(start - a.xy, d, a.z);
    if (type == kShapeRect) enters = enter_rounded_box(rotate_into(start - a.xy, b.xy), rotate_into(d, b.xy), a.zw, b.z);
    if (type == kShapeLine) enters = enter_capsule(start, d, a, b.z);
    if (type == kShapeEllipse) enters = enter_ellipse(rotate_into(start - a.xy, b.xy), rotate_into(d, b.xy), a.zw);
    return surface_light(enters < kFar ? start + enters * d : at, d, border, emission, budget);
}

// On along the beam's axis to t: what the media there give and take.
void passes_media(vec2 p, vec2 d, float t, inout int budget, inout float crossed, inout vec3 radiance, inout vec3 passes) {
    if (kSceneMedia == 0 || t <= crossed) return;
    vec3 gained, through;
    if (!cross_media(p, d, crossed, t, budget, gained, through)) {
        ++lost_rays;
        through = vec3(0.0);
    }
    radiance += passes * gained;
    passes *= through;
    crossed = t;
}

// Radiance met by a beam from p along d that is `width` wide at p and grows by `slope`; `passes` is the share of it that
// leaves the domain.
void march_cone(vec2 p, vec2 d, float width, float slope, vec4 domain, ivec2 border, inout int budget, out vec3 radiance, out vec3 passes) {
    radiance = vec3(0.0);
    passes = vec3(1.0);
    float stop = exit_distance(p, d, domain);
    float t = 0.0;
    ivec2 last_pixel = textureSize(distance_texture, 0) - 1;
    int beside = -1;           // the shape that the beam is passing
    float lowest = kFar;       // the axis' least distance to it so far
    float share = 0.0;         // covered where it was least
    vec2 beside_at = p;        // the axis there
    float beside_t = 0.0;
    float crossed = 0.0;       // media have been asked up to here
    bool approached = false;   // from here on: what is behind p is not met
    while (max(passes.r, max(passes.g, passes.b)) > 0.001) {
        ivec2 pixel = ivec2(0);
        float room = 0.0;
        float w = width;
        vec2 at = p;
        while (t < stop && budget > 0) {
            --budget;
            at = p + d * t;
            w = width + slope * t;
            pixel = clamp(ivec2(floor(at)) + border, ivec2(0), last_pixel);
            room = texelFetch(distance_texture, pixel, 0).r;
            if (room < kNear + 0.5 * w) break;
            t += room - kHalfDiagonal - 0.5 * w;
        }
        if (budget <= 0) {
            ++lost_rays;
            passes = vec3(0.0);  // blocked, never free
        }
        bool over = t >= stop;
        int shape = over ? -1 : texelFetch(material_texture, pixel, 0).r;
        vec4 head = texelFetch(shape_records, max(shape, 0) * kShapeTexels);
        int type = int(head.x);
        float exact = room;
        if (shape >= 0 && head.w > float(kMostMarchedEdges)) {
            exact = interpolated_distance(at, border, last_pixel) - head.y;
        } else if (shape >= 0 && type != kShapeBitmap) {
            exact = shape_distance(shape, at, kFar);
            budget -= type == kShapeEllipse ? kEllipseIterations : int(head.w);
        }
        bool near = !over && shape >= 0 && exact < 0.5 * w;
        if (beside >= 0 && (!near || shape != beside)) {
            // Past it: its share counts once, where the axis was nearest.
            if (approached) {
                passes_media(p, d, beside_t, budget, crossed, radiance, passes);
                vec3 light = shape_emission(beside, at);
                if (kSceneSurfaces != 0)
                    light = beam_light(beside, int(texelFetch(shape_records, beside * kShapeTexels).x), beside_at, d, beside_t, width + slope * beside_t, border, light, budget);
                radiance += passes * share * light;
                passes *= 1.0 - share;
            }
            beside = -1;
        }
        if (over) break;
        if (near) {
            float now = covered_share(shape, type, at, d, w);
            bool met = now < 0.0 ? exact <= head.y : now > 0.999 && exact <= 0.0;
            if (met) {
                vec3 light = shape_emission(shape, vec2(pixel - border) + 0.5);
                if (kSceneSurfaces != 0) light = surface_light(at, d, border, light, budget);
                passes_media(p, d, t, budget, crossed, radiance, passes);
                if (now < 0.0 && type != kShapeBitmap) light *= texelFetch(shape_records, shape * kShapeTexels + 1).w;
                radiance += passes * light;
                passes = vec3(0.0);
            } else if (now >= 0.0 && (beside < 0 || exact < lowest - 1e-4)) {
                approached = t > 0.0;
                beside = shape;
                lowest = exact;
                share = now;
                beside_at = at;
                beside_t = t;
            }
        }
        // No shape is nearer than the distance at the pixel's centre allows; the one asked is known better.
        t += max(clamp(abs(exact), kShortestStep, kHalfDiagonal), room - kHalfDiagonal);
    }
    passes_media(p, d, max(stop, crossed), budget, crossed, radiance, passes);
}
