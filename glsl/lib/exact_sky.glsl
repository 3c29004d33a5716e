// The light of a sky that changes with direction: a table around the circle, `sky_nodes` of the program that includes it.

// Integral of the sky's radiance from angle 0 on, and its radiance there.
void sky_at(float angle, out vec3 integral, out vec3 radiance) {
    float x = angle / kTwoPi;
    float turns = floor(x);
    x = (x - turns) * float(params.sky_nodes);
    int node = min(int(x), params.sky_nodes - 1);
    float f = x - float(node);
    float step = kTwoPi / float(params.sky_nodes);
    vec3 before = texelFetch(sky_nodes, 2 * node).rgb;
    vec3 here = texelFetch(sky_nodes, 2 * node + 1).rgb;
    vec3 there = texelFetch(sky_nodes, 2 * node + 3).rgb;
    vec3 total = texelFetch(sky_nodes, 2 * params.sky_nodes).rgb;
    vec3 within = step * f * (here + 0.5 * f * (there - here));
    // The table of a moment holds the integral with the direction; so narrow a part has one direction.
    float middle = step * (float(node) + 0.5 * f);
    if (kMoment == 1) within *= cos(middle);
    if (kMoment == 2) within *= sin(middle);
    integral = total * turns + before + within;
    radiance = mix(here, there, f);
}

vec3 sky_between(float a, float b, out vec3 at_b) {
    vec3 begin, end, before;
    sky_at(a, begin, before);
    sky_at(b, end, at_b);
    return end - begin;
}

// `weight`: what the integral counts for; 1 for the light of all directions alike.
void add_sky(bools which, reals a, reals b, reals weight, out reals r, out reals g, out reals bl) {
    reals share = pick(reals(0.0), weight, which);
#if EXACT_WIDTH == 4
    vec3 h0, h1, h2, h3;
    vec3 s0 = sky_between(a.x, b.x, h0);
    vec3 s1 = sky_between(a.y, b.y, h1);
    vec3 s2 = sky_between(a.z, b.z, h2);
    vec3 s3 = sky_between(a.w, b.w, h3);
    sum_r += share * vec4(s0.r, s1.r, s2.r, s3.r);
    sum_g += share * vec4(s0.g, s1.g, s2.g, s3.g);
    sum_b += share * vec4(s0.b, s1.b, s2.b, s3.b);
    r = vec4(h0.r, h1.r, h2.r, h3.r);
    g = vec4(h0.g, h1.g, h2.g, h3.g);
    bl = vec4(h0.b, h1.b, h2.b, h3.b);
#else
    vec3 there;
    vec3 integral = sky_between(a, b, there);
    sum_r += share * integral.r;
    sum_g += share * integral.g;
    sum_b += share * integral.b;
    r = there.r;
    g = there.g;
    bl = there.b;
#endif
}

// In which part of the sky, between two of its steps, an angle lies.
uint sky_part(float angle) {
    float x = angle / kTwoPi;
    int node = min(int((x - floor(x)) * float(params.sky_nodes)), params.sky_nodes - 1);
    return uint(texelFetch(sky_nodes, 2 * node + 1).a);
}

uints sky_parts(reals angle) {
#if EXACT_WIDTH == 4
    return uvec4(sky_part(angle.x), sky_part(angle.y), sky_part(angle.z), sky_part(angle.w));
#else
    return sky_part(angle);
#endif
}
