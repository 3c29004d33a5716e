// Radiance of surfaces that reflect, along directions from a point. Reads `entries`, `lights`, `surfaces` and `elements` of
// the program that includes it, for one point at a time.

// Of any x: from the form for several.
float angle_of(vec2 v) {
    vec2 a = abs(v);
    float small = min(a.x, a.y) / max(max(a.x, a.y), 1e-30);
    float angle = first_of(arctangent(reals(small)));
    if (a.y > a.x) angle = 1.5707963267948966 - angle;
    if (v.x < 0.0) angle = 3.141592653589793 - angle;
    return v.y < 0.0 ? -angle : angle;
}

// The course along a piece from 0 to 1, of its point in the direction d from p, `reach` times d away.
float course_at(int entry, int kind, vec4 surface, vec2 p, vec2 d, out float reach) {
    vec4 e = texelFetch(entries, entry);
    vec2 a = e.xy - p;
    if (kind == 0) {
        vec2 way = e.zw - e.xy;
        float facing = min(d.x * way.y - d.y * way.x, -1e-30);
        reach = (a.x * way.y - a.y * way.x) / facing;
        return clamp((a.x * d.y - a.y * d.x) / facing, 0.0, 1.0);
    }
    vec2 normal;
    if (kind < 3) {
        float b = dot(a, d);
        float dd = dot(d, d);
        float root = sqrt(max(b * b - dd * (dot(a, a) - e.z * e.z), 0.0));
        reach = (b - root) / dd;
        normal = d * reach - a;
    } else {
        vec4 frame = texelFetch(entries, entry + 1);
        vec2 q = -vec2(dot(frame.xy, a), dot(frame.zw, a));
        vec2 w = vec2(dot(frame.xy, d), dot(frame.zw, d));
        float b = -dot(q, w);
        float ww = dot(w, w);
        float root = sqrt(max(b * b - ww * (dot(q, q) - 1.0), 0.0));
        reach = (b - root) / ww;
        normal = q + w * reach;
    }
    float turned = angle_of(normal) - surface.z;
    turned -= kTwoPi * floor(turned / kTwoPi);
    // Rounding just before the start must not become the end.
    if (turned > 0.5 * (surface.w + kTwoPi)) turned = surface.y < 0.0 ? turned : 0.0;
    return min(turned / surface.w, 1.0);
}

struct Shine {
    vec3 radiance;
    vec3 integral;  // of radiance from u = 0 on
    float u;
    int element;
    float t;        // within the element
};

// How elements are spread: small towards the ends of a piece, where light bends (core/plan/surfaces.cpp).
float element_of(float u) { return u < 0.5 ? sqrt(0.5 * u) : 1.0 - sqrt(0.5 * (1.0 - u)); }

Shine shine_at(vec4 surface, float u) {
    Shine s;
    float count = abs(surface.y);
    s.u = u;
    s.element = int(surface.x) + int(clamp((surface.y < 0.0 ? u : element_of(u)) * count, 0.0, count - 1.0));
    vec4 start = texelFetch(elements, kExactElementTexels * s.element);
    vec4 mean = texelFetch(elements, kExactElementTexels * s.element + 1);
    vec3 change = texelFetch(elements, kExactElementTexels * s.element + 2).rgb;
    s.t = clamp((u - start.a) / mean.a, 0.0, 1.0);
    s.radiance = mean.rgb + change * (s.t - 0.5);
    s.integral = start.rgb + mean.a * s.t * (mean.rgb + 0.5 * change * (s.t - 1.0));
    return s;
}

// The mean over the course from a to b, weighted as `where`, the mean course over directions, says.
vec3 mean_between(vec4 surface, Shine a, Shine b, float where) {
    float du = b.u - a.u;
    vec3 sum = b.integral - a.integral;
    if (surface.y < 0.0 && abs(du) > 0.5) {
        // Around a whole curve, past its start.
        vec3 all = texelFetch(elements, kExactElementTexels * (int(surface.x) + int(-surface.y))).rgb;
        sum += du > 0.0 ? -all : all;
        du += du > 0.0 ? -1.0 : 1.0;
    }
    vec3 middle = 0.5 * (a.radiance + b.radiance);
    if (a.element == b.element || abs(du) < 1e-6) return max(middle + (b.radiance - a.radiance) * (where - 0.5), vec3(0.0));
    return max(sum / du + (b.radiance - a.radiance) * (where - 0.5), vec3(0.0));
}

// The point of a curved piece at a course, from p.
vec2 curve_point(int entry, int kind, vec4 surface, float u, vec2 p) {
    vec2 centre = texelFetch(entries, entry).xy - p;
    float angle = surface.z + surface.w * u;
    vec2 around = vec2(cos(angle), sin(angle));
    if (kind < 3) return centre + texelFetch(entries, entry).z * around;
    vec4 back = texelFetch(entries, entry + 3);
    return centre + back.xy * around.x + back.zw * around.y;
}

// Mean radiance of an entry's piece between the keys k0 and `middle`, and between that and k2 (means over direction), its
// radiance at the first and the last, and its depth at the one between. Straight pieces are halved by direction, curved ones
// by course: towards the rim of what is seen of them the course runs away.
void surface_light(int entry, int kind, vec2 p, float k0, float k2, out float middle, out vec3 mean0, out vec3 mean1, out vec3 at0,
                   out vec3 at2, out float depth) {
    vec4 surface = texelFetch(surfaces, int(texelFetch(lights, entry).a));
    float other;
    float u0 = course_at(entry, kind, surface, p, axis + side * k0, other);
    float u2 = course_at(entry, kind, surface, p, axis + side * k2, other);
    middle = 0.5 * (k0 + k2);
    float u1;
    if (kind == 0) {
        u1 = course_at(entry, kind, surface, p, axis + side * middle, depth);
    } else {
        // Seen towards growing angles a course runs down.
        u1 = 0.5 * (u0 + u2) + (u2 > u0 && surface.y < 0.0 ? 0.5 : 0.0);
        vec2 to = curve_point(entry, kind, surface, u1, p);
        depth = dot(axis, to);
        middle = clamp(dot(side, to) / max(depth, 1e-6), k0, k2);
        u1 -= floor(u1);
    }
    Shine s0 = shine_at(surface, u0);
    Shine s1 = shine_at(surface, u1);
    Shine s2 = shine_at(surface, u2);
    float w0 = 0.5, w1 = 0.5;
    if (kind == 0) {
        // The course as a quadratic of the direction: where its mean over each half lies between the half's ends.
        float bend = u0 - 2.0 * u1 + u2;
        w0 = u1 == u0 ? 0.5 : 0.5 - bend / (12.0 * (u1 - u0));
        w1 = u2 == u1 ? 0.5 : 0.5 - bend / (12.0 * (u2 - u1));
    } else {
        // The direction as a quadratic of the course.
        float t0 = max(4.0 * (middle - k0) - (k2 - k0), 0.0), t1 = k2 - k0, t2 = max(4.0 * (k2 - middle) - (k2 - k0), 0.0);
        w0 = (t0 + 2.0 * t1) / max(3.0 * (t0 + t1), 1e-20);
        w1 = (t1 + 2.0 * t2) / max(3.0 * (t1 + t2), 1e-20);
    }
    mean0 = mean_between(surface, s0, s1, clamp(w0, 0.0, 1.0));
    mean1 = mean_between(surface, s1, s2, clamp(w1, 0.0, 1.0));
    at0 = s0.radiance;
    at2 = s2.radiance;
}

vec3 surface_at(int entry, int kind, vec2 p, float k) {
    vec4 surface = texelFetch(surfaces, int(texelFetch(lights, entry).a));
    float reach;
    return shine_at(surface, course_at(entry, kind, surface, p, axis + side * k, reach)).radiance;
}
