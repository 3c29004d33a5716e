// What the floor sends up of light from a direction, or of light known by its moments: core/floor/floor.cpp on the device.

layout(binding = kFloorAlbedoUnit) uniform sampler2D albedo_texture;
layout(binding = kFloorNormalUnit) uniform sampler2D normal_texture;
layout(binding = kFloorTableUnit) uniform samplerBuffer response_table;

// Which program this is: whether the floor shines.
const int kGloss = 1;

const float kFloorInversePi = 0.3183098861837907;

struct FloorPlace {
    vec3 normal;
    vec2 lean;                  // where it leans to, a unit vector, or 0
    vec3 diffuse, facets, rim;  // colours of the parts of its response
    vec4 low, high;             // response to a field of light
    float alpha;
};

float fifth(float x) { return (x * x) * (x * x) * x; }

vec3 floor_albedo_at(ivec2 at) { return texelFetch(albedo_texture, min(at, textureSize(albedo_texture, 0) - 1), 0).rgb; }

FloorPlace floor_at(ivec2 at) {
    FloorPlace f;
    vec3 albedo = floor_albedo_at(at);
    f.normal = texelFetch(normal_texture, min(at, textureSize(normal_texture, 0) - 1), 0).rgb;
    float level = length(f.normal.xy);
    f.lean = level > 0.0 ? f.normal.xy / level : vec2(0.0);
    float place = level > 0.0 ? atan(level, f.normal.z) * (2.0 * kFloorInversePi) * float(kFloorTilts - 1) : 0.0;
    int i = clamp(int(place), 0, kFloorTilts - 2);
    float t = place - float(i);
    f.low = mix(texelFetch(response_table, 2 * i), texelFetch(response_table, 2 * i + 2), t);
    f.diffuse = albedo;
    if (kGloss != 0) {
        f.high = mix(texelFetch(response_table, 2 * i + 1), texelFetch(response_table, 2 * i + 3), t);
        vec4 gloss = texelFetch(response_table, 2 * kFloorTilts);
        f.alpha = gloss.x;
        vec3 f0 = gloss.z * (1.0 - gloss.y) + gloss.y * albedo;
        vec3 more = 1.0 + f0 * (1.0 / f.high.z - 1.0);
        f.diffuse = (1.0 - gloss.y) * albedo * (1.0 - f0);
        f.facets = f0 * more;
        f.rim = more;
    }
    return f;
}

// Of a field by its mean radiance, and the means of its radiance times direction.
vec3 floor_field(FloorPlace f, vec3 mean, vec3 x, vec3 y) {
    vec3 lean = x * f.lean.x + y * f.lean.y;
    vec3 sent = f.diffuse * (f.low.x * mean + f.low.y * lean);
    if (kGloss != 0) sent += f.facets * (f.low.z * mean + f.low.w * lean) + f.rim * (f.high.x * mean + f.high.y * lean);
    return max(sent, vec3(0.0));
}

// Of a beam with the illuminance 1 across it.
vec3 floor_beam(FloorPlace f, vec3 light) {
    float nl = dot(f.normal, light);
    if (kGloss == 0) return f.diffuse * (max(nl, 0.0) * kFloorInversePi);
    float nv = f.normal.z + 1e-5;
    vec3 half_way = light + vec3(0.0, 0.0, 1.0);
    float size = length(half_way);
    float lh = dot(light, half_way) / size;
    float rim = fifth(1.0 - lh);
    nl = max(nl, 1e-6);
    // 1 - n.h^2 keeps its digits as a cross product.
    vec3 off = cross(f.normal, half_way / size);
    float nh = dot(f.normal, half_way) / size;
    float a = nh * f.alpha;
    float k = f.alpha / (dot(off, off) + a * a);
    float a2 = f.alpha * f.alpha;
    float visibility = 0.5 / (nv * sqrt(nl * nl * (1.0 - a2) + a2) + nl * sqrt(nv * nv * (1.0 - a2) + a2));
    float facets = k * k * kFloorInversePi * visibility * nl;
    float f90 = 0.5 + 2.0 * f.alpha * lh * lh;
    float burley = (1.0 + (f90 - 1.0) * fifth(1.0 - nl)) * (1.0 + (f90 - 1.0) * fifth(1.0 - min(nv, 1.0))) * kFloorInversePi;
    vec3 sent = f.diffuse * (burley * nl * (1.0 - rim)) + f.facets * (facets * (1.0 - rim)) + f.rim * (facets * rim);
    return dot(f.normal, light) > 0.0 ? sent : vec3(0.0);
}
