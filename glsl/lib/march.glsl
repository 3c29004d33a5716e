// One interval of a ray by sphere tracing over the distance texture, each texel fetched exactly (a linear
// filter costs half the accuracy: docs/decisions).
#include "lib/scene.glsl"

layout(binding = kCascadeDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kCascadeMaterialUnit) uniform isampler2D material_texture;

// Distance along the ray at which it leaves the box (x0 y0 x1 y1); negative when it starts outside.
float exit_distance(vec2 p, vec2 d, vec4 box) {
    vec2 lo = (box.xy - p) / d;
    vec2 hi = (box.zw - p) / d;
    vec2 leave = max(lo, hi);
    // A component of 0 never leaves through its sides.
    if (d.x == 0.0) leave.x = kFar;
    if (d.y == 0.0) leave.y = kFar;
    return min(leave.x, leave.y);
}

const int kRayPassed = 0;   // free to its end
const int kRayBlocked = 1;  // met a shape, or ran out of steps
const int kRayLeft = 2;     // left the domain

// Within this of a surface (measured at the pixel's centre) the outline itself is asked, so that shapes keep
// their size to a fraction of a pixel and walls thinner than a pixel hold. Far from surfaces the distance at the
// centre is safe when half the pixel's diagonal is taken off.
const float kNear = 1.5;
const float kHalfDiagonal = 0.7072;
// Nearest to a surface, steps are no shorter than this: a wall must be as thick to be seen from every angle.
const float kShortestStep = 0.25;

// Radiance met between start and end along the ray.
int march(vec2 p, vec2 d, float start, float end, vec4 domain, ivec2 border, out vec3 radiance) {
    radiance = vec3(0.0);
    float leave = exit_distance(p, d, domain);
    float stop = min(end, leave);
    float t = start;
    ivec2 last_pixel = textureSize(distance_texture, 0) - 1;
    for (int i = 0; i < kMaxMarchSteps; ++i) {
        if (t >= stop) return leave <= end ? kRayLeft : kRayPassed;
        vec2 at = p + d * t;
        ivec2 pixel = clamp(ivec2(floor(at)) + border, ivec2(0), last_pixel);
        float room = texelFetch(distance_texture, pixel, 0).r;
        if (room >= kNear) {
            t += room - kHalfDiagonal;
            continue;
        }
        float step = kShortestStep;
        int shape = texelFetch(material_texture, pixel, 0).r;
        if (shape >= 0) {
            vec4 head = texelFetch(shape_records, shape * kShapeTexels);
            bool bitmap = int(head.x) == kShapeBitmap;
            float exact = bitmap ? room : shape_distance(shape, at, kFar) - head.y;
            if (exact <= 0.0) {
                radiance = shape_emission(shape, vec2(pixel - border) + 0.5);
                if (!bitmap) radiance *= texelFetch(shape_records, shape * kShapeTexels + 1).w;
                return kRayBlocked;
            }
            // Another shape may be nearer here than at the pixel's centre: stay within the pixel.
            step = clamp(exact, kShortestStep, kHalfDiagonal);
        }
        t += step;
    }
    return kRayBlocked;
}
