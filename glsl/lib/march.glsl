// One interval of a ray by sphere tracing over the distance texture, each texel fetched exactly (a linear
// filter costs half the accuracy: docs/decisions).
#include "lib/domain.glsl"
#include "lib/scene.glsl"
#include "lib/surface_light.glsl"
#include "lib/media.glsl"

layout(binding = kCascadeDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kCascadeMaterialUnit) uniform isampler2D material_texture;

// Rays that ran out of steps count as blocked, and are counted.
layout(std430, binding = kLostRaysStorage) buffer LostRayCounters { uint lost_ray_counts[]; };
uint lost_rays = 0u;  // of this invocation

void report_lost_rays() {
    if (lost_rays > 0u) atomicAdd(lost_ray_counts[0], lost_rays);
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

// The distance at p, interpolated between the four nearest pixel centres: exact beside a straight edge.
float interpolated_distance(vec2 p, ivec2 border, ivec2 last_pixel) {
    vec2 q = p - 0.5;
    ivec2 base = ivec2(floor(q));
    vec2 f = q - vec2(base);
    ivec2 lo = clamp(base + border, ivec2(0), last_pixel);
    ivec2 hi = clamp(base + border + 1, ivec2(0), last_pixel);
    float top = mix(texelFetch(distance_texture, lo, 0).r, texelFetch(distance_texture, ivec2(hi.x, lo.y), 0).r, f.x);
    float bottom = mix(texelFetch(distance_texture, ivec2(lo.x, hi.y), 0).r, texelFetch(distance_texture, hi, 0).r, f.x);
    return mix(top, bottom, f.y);
}

// Whether a march from p would be blocked at once: the question that march() asks, of the same outline.
bool starts_inside(vec2 p, ivec2 border) {
    ivec2 last_pixel = textureSize(distance_texture, 0) - 1;
    ivec2 pixel = clamp(ivec2(floor(p)) + border, ivec2(0), last_pixel);
    float room = texelFetch(distance_texture, pixel, 0).r;
    if (room >= kNear) return false;
    float d = interpolated_distance(p, border, last_pixel);
    int shape = texelFetch(material_texture, pixel, 0).r;
    if (shape < 0) return d <= 0.0;
    vec4 head = texelFetch(shape_records, shape * kShapeTexels);
    if (int(head.x) == kShapeBitmap) return room <= 0.0;
    if (head.w > float(kMostMarchedEdges)) return d <= 0.0;
    return shape_distance(shape, p, kFar) <= 0.0;
}

// A march may begin deep inside a shape, where a neighbouring probe's ends: back to the surface where a ray along d comes in.
vec2 where_it_entered(vec2 at, vec2 d, ivec2 border, ivec2 last_pixel, inout int budget) {
    const int most = 64;
    int i = 0;
    for (; i < most; ++i) {
        float room = texelFetch(distance_texture, clamp(ivec2(floor(at)) + border, ivec2(0), last_pixel), 0).r;
        if (room > -kHalfDiagonal) break;
        at -= max(-room - kHalfDiagonal, kShortestStep) * d;
    }
    budget -= i + 1;
    return at;
}

// Which program this is: whether a debug view counts loop iterations instead of gathering light.
const int kCountSteps = 0;

float march_end;  // where the last march ended, along its ray

// Radiance met between start and end along the ray. Spends of the invocation's loop iterations.
int march(vec2 p, vec2 d, float start, float end, vec4 domain, ivec2 border, inout int budget, out vec3 radiance) {
    radiance = vec3(0.0);
    float leave = exit_distance(p, d, domain);
    float stop = min(end, leave);
    float t = start;
    ivec2 last_pixel = textureSize(distance_texture, 0) - 1;
    int hit = -1;
    vec2 hit_at = p;
    vec2 end_at = p;
    int fate = kRayBlocked;
    while (budget > 0) {
        // The tight loop: free steps far from any surface. What is inside the outer loop alone is paid once per
        // approach, not once per step (llvmpipe runs both sides of a branch).
        ivec2 pixel = ivec2(0);
        float room = 0.0;
        vec2 at = p;
        while (t < stop && budget > 0) {
            --budget;
            at = p + d * t;
            pixel = clamp(ivec2(floor(at)) + border, ivec2(0), last_pixel);
            room = texelFetch(distance_texture, pixel, 0).r;
            if (room < kNear) break;
            t += room - kHalfDiagonal;
        }
        if (t >= stop) { fate = leave <= end ? kRayLeft : kRayPassed; break; }
        float step = kShortestStep;
        int shape = texelFetch(material_texture, pixel, 0).r;
        if (shape >= 0) {
            vec4 head = texelFetch(shape_records, shape * kShapeTexels);
            int type = int(head.x);
            float exact = room;
            if (head.w > float(kMostMarchedEdges)) {
                exact = interpolated_distance(at, border, last_pixel) - head.y;
            } else if (type != kShapeBitmap) {
                exact = shape_distance(shape, at, kFar) - head.y;
                budget -= type == kShapeEllipse ? kEllipseIterations : int(head.w);
            }
            if (exact <= 0.0) {
                hit = shape;
                hit_at = vec2(pixel - border) + 0.5;
                end_at = at;
                break;
            }
            // Another shape may be nearer here than at the pixel's centre: stay within the pixel.
            step = clamp(exact, kShortestStep, kHalfDiagonal);
        }
        // The last step of an interval ends on its end: what is met there is not left to other probes.
        t = t + step >= stop && t < stop - 0.01 ? stop - 0.005 : t + step;
    }
    if (hit < 0 && fate == kRayBlocked) ++lost_rays;
    march_end = min(t, stop);
    if (hit >= 0) {
        radiance = shape_emission(hit, hit_at);
        if (kSceneSurfaces != 0) radiance = surface_light(where_it_entered(end_at, d, border, last_pixel, budget), d, border, radiance, budget);
        if (int(texelFetch(shape_records, hit * kShapeTexels).x) != kShapeBitmap) radiance *= texelFetch(shape_records, hit * kShapeTexels + 1).w;
    }
    return fate;
}

// The same with the media on the way: `through` is the share of what comes from beyond that arrives.
int march_through(vec2 p, vec2 d, float start, float end, vec4 domain, ivec2 border, inout int budget, out vec3 radiance, out vec3 through) {
    int fate = march(p, d, start, end, domain, border, budget, radiance);
    through = vec3(1.0);
    if (kSceneMedia != 0) {
        vec3 gained;
        if (!cross_media(p, d, start, march_end, budget, gained, through)) {
            ++lost_rays;
            through = vec3(0.0);  // blocked, never free
        }
        radiance = gained + through * radiance;
    }
    if (fate == kRayBlocked) through = vec3(0.0);
    return fate;
}
