// Light from lights without a size, and whether something stands in its way. Reads `entries` and `lights` of the program that
// includes it.

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// A light stands on an outline without being hidden by it; and rounding is no wall.
const float kDeltaSlack = 1e-3;  // px

// Arrival at p: towards the light (as long as the light is far; any length where it has no distance), flatland's irradiance across
// the beam, shadows left out, and what the floor has of it: the mean radiance times 2 pi.
struct Arrival {
    vec2 way;
    float end;      // share of `way` within which something hides the light
    vec3 strength;
    vec3 on_floor;
    vec3 across;    // of lights above the canvas: illuminance across the beam,
    float up;       // and the sine of its elevation; else 0
};

const float kInversePi = 0.3183098861837907;

// A spot's share this far from its axis, exact for narrow beams: (cos off - cos outer) / (cos inner - cos outer), squared.
float spot_share(vec4 spot, float off) {
    float ramp = spot.w <= spot.z ? (off <= spot.w ? 1.0 : 0.0)
        : clamp(sin(0.5 * (spot.w + off)) * sin(0.5 * (spot.w - off)) / (sin(0.5 * (spot.w + spot.z)) * sin(0.5 * (spot.w - spot.z))), 0.0, 1.0);
    return ramp * ramp;
}

// The angle between a spot's axis and the way from it.
float off_axis(vec4 spot, float tilt, vec3 from) {
    vec3 axis = vec3(spot.xy * cos(tilt), -sin(tilt));
    return atan(length(cross(axis, from)), dot(axis, from));
}

Arrival arrival_at(int light, vec2 p, float least_distance) {
    vec4 head = texelFetch(lights, kDeltaLightTexels * light);
    vec4 intensity = texelFetch(lights, kDeltaLightTexels * light + 1);
    vec4 spot = texelFetch(lights, kDeltaLightTexels * light + 2);
    Arrival a;
    int kind = int(head.z);
    bool raised = (kind & kDeltaRaised) != 0;
    kind &= 3;
    float up, level;  // sine and cosine of the light's elevation
    if (kind == kDeltaDirectional) {
        a.way = head.xy;
        a.end = 1e30;
        a.strength = intensity.rgb;
        up = head.w;
        level = intensity.w;
    } else {
        a.way = head.xy - p;
        float r = length(a.way);
        a.end = 1.0 - kDeltaSlack / max(r, kDeltaSlack);
        float d = raised ? length(vec2(r, head.w)) : max(r, least_distance);
        up = head.w / d;
        level = r / d;
        a.strength = intensity.rgb / d;
        if (raised) a.strength /= d;
        // At the light itself no direction is off the axis.
        if (kind == kDeltaSpot && (raised || r > 0.0)) a.strength *= spot_share(spot, off_axis(spot, raised ? intensity.w : 0.0, vec3(-a.way, raised ? -head.w : 0.0)));
    }
    a.across = a.strength;
    a.up = raised ? up : 0.0;
    a.on_floor = a.strength * (raised ? 2.0 * up : 1.0);
    if (raised) a.strength *= 2.0 * kInversePi * level;
    return a;
}

bool straight_hides(vec4 e, vec2 p, vec2 way, float end) {
    vec2 a = e.xy - p;
    vec2 b = e.zw - p;
    vec2 along = b - a;
    float rise = cross2(a, along);
    float facing = cross2(way, along);
    // Seen towards growing angles from b to a, the front alone; pieces that share a corner leave no gap.
    return rise < 0.0 && cross2(b, way) >= 0.0 && cross2(way, a) > 0.0 && rise > end * facing;
}

// Where a ray enters a circle: the share of its way, or -1.
float enter_round(vec2 v, float radius, vec2 way, out vec2 normal) {
    float b = dot(v, way);
    float ww = dot(way, way);
    float off = cross2(v, way);
    float room = ww * radius * radius - off * off;
    float rise = dot(v, v) - radius * radius;
    float t = rise / max(b + sqrt(max(room, 0.0)), 1e-30);
    normal = way * t - v;
    return room > 0.0 && rise > 0.0 && b > 0.0 ? t : -1.0;
}

// Whether a normal lies between those of an arc's ends.
bool on_arc(vec2 a, vec2 b, vec2 normal) {
    bool after = cross2(a, normal) >= 0.0;
    bool before = cross2(normal, b) >= 0.0;
    return cross2(a, b) >= 0.0 && dot(a, b) > -0.999999 * length(a) * length(b) ? after && before : after || before;
}

bool hides(int first, int straights, int discs, int arcs, int ellipses, vec2 p, vec2 way, float end) {
    int at = first;
    vec2 normal;
    for (int stop = at + straights; at < stop; ++at) {
        if (straight_hides(texelFetch(entries, at), p, way, end)) return true;
    }
    for (int stop = at + discs; at < stop; ++at) {
        vec4 e = texelFetch(entries, at);
        float t = enter_round(e.xy - p, e.z, way, normal);
        if (t > 0.0 && t < end) return true;
    }
    for (int stop = at + 2 * arcs; at < stop; at += 2) {
        vec4 e = texelFetch(entries, at);
        vec4 ends = texelFetch(entries, at + 1);
        float t = enter_round(e.xy - p, e.z, way, normal);
        if (t > 0.0 && t < end && on_arc(ends.xy - e.xy, ends.zw - e.xy, normal)) return true;
    }
    for (int stop = at + 4 * ellipses; at < stop; at += 4) {
        vec4 e = texelFetch(entries, at);
        vec4 frame = texelFetch(entries, at + 1);
        vec4 ends = texelFetch(entries, at + 2);
        vec2 v = e.xy - p;
        float t = enter_round(vec2(dot(frame.xy, v), dot(frame.zw, v)), 1.0, vec2(dot(frame.xy, way), dot(frame.zw, way)), normal);
        vec2 a = ends.xy - e.xy, b = ends.zw - e.xy;
        if (t > 0.0 && t < end && (e.w != 0.0 || on_arc(vec2(dot(frame.xy, a), dot(frame.zw, a)), vec2(dot(frame.xy, b), dot(frame.zw, b)), normal))) return true;
    }
    return false;
}

bool list_hides(uvec4 head, vec2 p, vec2 way, float end) {
    if (head.x >= kDeltaOpen) return head.x == kDeltaDark;
    return hides(int(head.x), int(head.y & 0xffffu), int(head.y >> 16), int(head.z & 0xffffu), int(head.z >> 16), p, way, end);
}
