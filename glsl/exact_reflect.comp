// Reads the irradiance of elements; writes what they shine with after one more reflection: emission and half the albedo times
// the irradiance, its change across each element, and its integral along the piece. One thread is one piece.
#version 430 core
#include "exact.h"
#include "lib/pick.glsl"

layout(local_size_x = kExactGroupX, local_size_y = kExactGroupY) in;
layout(std140, binding = kExactParamsBinding) uniform Params { ExactParams params; };
layout(binding = kExactSurfacesUnit) uniform samplerBuffer surfaces;
layout(binding = kExactElementsUnit) uniform samplerBuffer elements_before;
layout(binding = kExactMaterialsUnit) uniform samplerBuffer materials;
layout(binding = kExactNodeValuesUnit) uniform sampler2D irradiance;
layout(binding = kExactNodeLightsUnit) uniform sampler2D light_irradiance;
layout(std430, binding = kExactElementsStorage) writeonly buffer Elements { vec4 elements[]; };
layout(std430, binding = kExactChangeStorage) buffer ChangeCounters { uint change[]; };

vec3 reflected(int element, vec3 half_albedo) {
    ivec2 at = ivec2(element % kExactNodeRow, element / kExactNodeRow);
    vec3 arriving = vec3(0.0);
    if (params.level != 0) {
        arriving = texelFetch(irradiance, at, 0).rgb;
        if (params.light_scale > 0.0) arriving += params.light_scale * texelFetch(light_irradiance, at, 0).rgb;
    }
    // What does not reflect has not been asked for its irradiance.
    return pick(vec3(0.0), half_albedo * arriving, greaterThan(half_albedo, vec3(0.0)));
}

// Where element `index` starts.
float course_of(int index, float count, bool whole) {
    float x = float(index) / count;
    if (whole) return x;
    return x < 0.5 ? 2.0 * x * x : 1.0 - 2.0 * (1.0 - x) * (1.0 - x);
}

vec3 smaller(vec3 a, vec3 b) { return pick(vec3(0.0), sign(a) * min(abs(a), abs(b)), greaterThan(a * b, vec3(0.0))); }

void main() {
    int piece = int(gl_GlobalInvocationID.x);
    if (piece >= params.extent.x) return;
    vec4 surface = texelFetch(surfaces, piece);
    vec3 emission = texelFetch(materials, kExactMaterialTexels * piece).rgb;
    vec3 gradient = texelFetch(materials, kExactMaterialTexels * piece + 1).rgb;
    vec3 half_albedo = texelFetch(materials, kExactMaterialTexels * piece + 2).rgb;
    int first = int(surface.x);
    int count = abs(int(surface.y));
    bool whole = surface.y < 0.0;
    float n = float(count);
    vec3 sum = vec3(0.0);
    vec3 most_change = vec3(0.0);
    vec3 most = vec3(0.0);
    vec3 here = reflected(first, half_albedo);
    vec3 before = whole ? reflected(first + count - 1, half_albedo) : here;
    float size_before = whole ? 1.0 / n : 0.0;
    for (int i = 0; i < count; ++i) {
        float u = course_of(i, n, whole);
        float size = course_of(i + 1, n, whole) - u;
        int next = i + 1 < count ? i + 1 : whole ? 0 : i;
        vec3 after = reflected(first + next, half_albedo);
        float size_after = i + 1 < count ? course_of(i + 2, n, whole) - (u + size) : whole ? 1.0 / n : 0.0;
        // Slopes from the differences to either side: the centred one, held to twice the smaller (MC limiter, van Leer 1977).
        float back_way = 0.5 * (size_before + size), on_way = 0.5 * (size + size_after);
        vec3 back = (here - before) / back_way, on = (after - here) / on_way;
        bool has_back = size_before > 0.0, has_on = size_after > 0.0;
        vec3 slope = has_back && has_on ? smaller((back * on_way + on * back_way) / (back_way + on_way), 2.0 * smaller(back, on))
                                        : has_back ? back : has_on ? on : vec3(0.0);
        // What is emitted changes evenly.
        vec3 shine = here + emission + gradient * (u + 0.5 * size);
        vec3 across = clamp(slope * size + gradient * size, -2.0 * shine, 2.0 * shine);
        int at = kExactElementTexels * (first + i);
        if (params.level != 0) most_change = max(most_change, abs(shine - texelFetch(elements_before, at + 1).rgb));
        most = max(most, shine);
        elements[at] = vec4(sum, u);
        elements[at + 1] = vec4(shine, size);
        elements[at + 2] = vec4(across, 0.0);
        sum += size * shine;
        before = here;
        here = after;
        size_before = size;
    }
    elements[kExactElementTexels * (first + count)] = vec4(sum, 1.0);
    atomicMax(change[0], floatBitsToUint(max(most_change.r, max(most_change.g, most_change.b))));
    atomicMax(change[1], floatBitsToUint(max(most.r, max(most.g, most.b))));
}
