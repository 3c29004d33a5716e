// What the surface shines with that a ray has met: light that bounces.
#include "surface_records.h"

layout(binding = kSurfaceHeadsUnit) uniform usamplerBuffer surface_heads;
layout(binding = kSurfaceChordsUnit) uniform samplerBuffer surface_chords;

// Which program this is: whether surfaces shine with more than their emission.
const int kSceneSurfaces = 0;

// Radiance of the chord nearest to `at`, of those that face a ray along d: a wall has two sides, however thin it is. `otherwise`
// where there is none. Spends of the invocation's loop iterations.
vec3 surface_light(vec2 at, vec2 d, ivec2 border, vec3 otherwise, inout int budget) {
    ivec2 cells = ivec2(texelFetch(surface_heads, 0).rg);
    ivec2 cell = clamp((ivec2(floor(at)) + border) / kSurfaceCell, ivec2(0), cells - 1);
    ivec2 head = ivec2(texelFetch(surface_heads, 1 + cell.y * cells.x + cell.x).rg);
    float nearest = 1e30;
    int found = -1;
    float place = 0.5;
    budget -= head.y - head.x;
    for (int i = head.x; i < head.y; ++i) {
        vec4 ends = texelFetch(surface_chords, i * kSurfaceChordTexels);
        vec2 along = ends.zw - ends.xy;
        float h = clamp(dot(at - ends.xy, along) / max(dot(along, along), 1e-20), 0.0, 1.0);
        vec2 way = at - ends.xy - h * along;
        float away = dot(way, way);
        // The outward normal is (along.y, -along.x). What faces away counts where nothing else does.
        if (along.y * d.x - along.x * d.y >= 0.0) away += 1e4;
        if (away < nearest) {
            nearest = away;
            found = i;
            place = h;
        }
    }
    if (found < 0) return otherwise;
    return max(texelFetch(surface_chords, found * kSurfaceChordTexels + 1).rgb + (place - 0.5) * texelFetch(surface_chords, found * kSurfaceChordTexels + 2).rgb, vec3(0.0));
}
