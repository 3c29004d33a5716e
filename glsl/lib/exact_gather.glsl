// What directions weigh, how edges change the light, and the light of surfaces that reflect: of four points at once. Reads the state of
// the walk of glsl/exact_solve.comp.

vec4 normal_x, normal_y;  // of surfaces' points

// The integral of the cosine from the normal's right up to a key; behind the surface it does not change.
vec4 cosine_up_to(vec4 key) {
    vec4 x = axis.x + side.x * key, y = axis.y + side.y * key;
    vec4 sine = (normal_x * y - normal_y * x) * inversesqrt(1.0 + key * key);
    bvec4 front = greaterThan(normal_x * x + normal_y * y, vec4(0.0));
    return pick(sign(sine), sine, front);
}

// The direction's component that is asked for, at a key.
vec4 direction_of(vec4 key) {
    float along = kMoment == 1 ? axis.x : axis.y;
    float across = kMoment == 1 ? side.x : side.y;
    return (along + across * key) * inversesqrt(1.0 + key * key);
}

// What directions between two keys weigh.
vec4 weight_of(vec4 a, vec4 b) {
    if (kNodes != 0) return max(cosine_up_to(b) - cosine_up_to(a), vec4(0.0));
    vec4 angle = arctangent((b - a) / (1.0 + b * a));
    if (kMoment == 0) return angle;
    // The integral of a unit vector is the chord: 2 sin(angle / 2) along the middle. The angle is within a sector.
    vec4 h2 = 0.25 * angle * angle;
    vec4 chord = angle * (1.0 - h2 * (1.0 / 6.0 - h2 * (1.0 / 120.0 - h2 / 5040.0)));
    vec4 ia = inversesqrt(1.0 + a * a), ib = inversesqrt(1.0 + b * b);
    vec4 ahead = ia + ib, aside = a * ia + b * ib;
    float along = kMoment == 1 ? axis.x : axis.y;
    float across = kMoment == 1 ? side.x : side.y;
    return chord * (along * ahead + across * aside) * inversesqrt(max(ahead * ahead + aside * aside, vec4(1e-30)));
}

int kind_of(float entry) { return entry < float(first_disc) ? 0 : entry < float(first_arc) ? 1 : entry < float(first_ellipse) ? 2 : 3; }

void add_slopes(vec4 jr, vec4 jg, vec4 jb, vec4 key, vec4 weight) {
    vec4 inverse = inversesqrt(1.0 + key * key);
    vec4 along = (axis.y + side.y * key) * inverse * weight;
    vec4 across = (axis.x + side.x * key) * inverse * weight;
    slope_x_r += jr * along;
    slope_x_g += jg * along;
    slope_x_b += jb * along;
    slope_y_r -= jr * across;
    slope_y_g -= jg * across;
    slope_y_b -= jb * across;
}

// One point after another: the program stays small, and the driver has less to compile.
vec4 lane_of(int k) { return vec4(equal(ivec4(0, 1, 2, 3), ivec4(k))); }

// The light of surfaces from `from` to `to`; top_r, top_g, top_b become their radiance at `to`.
void gather_surfaces(bvec4 which, vec4 to) {
    vec4 entry = max(top, vec4(0.0));
    vec4 middle = vec4(0.0), depth = vec4(0.0);
    vec4 ar = vec4(0.0), ag = vec4(0.0), ab = vec4(0.0), br = vec4(0.0), bg = vec4(0.0), bb = vec4(0.0);
    vec4 pr = vec4(0.0), pg = vec4(0.0), pb = vec4(0.0), qr = vec4(0.0), qg = vec4(0.0), qb = vec4(0.0);
    for (int k = 0; k < 4; ++k) {
        vec4 lane = lane_of(k);
        vec3 a, b, p, q;
        float m, d;
        float e = dot(lane, entry);
        surface_light(int(e), kind_of(e), vec2(dot(lane, px), dot(lane, py)), dot(lane, from), dot(lane, to), m, a, b, p, q, d);
        middle += lane * m;
        depth += lane * d;
        ar += lane * a.r;
        ag += lane * a.g;
        ab += lane * a.b;
        br += lane * b.r;
        bg += lane * b.g;
        bb += lane * b.b;
        pr += lane * p.r;
        pg += lane * p.g;
        pb += lane * p.b;
        qr += lane * q.r;
        qg += lane * q.g;
        qb += lane * q.b;
    }
    vec4 before = pick(vec4(0.0), weight_of(from, middle), which);
    vec4 after = pick(vec4(0.0), weight_of(middle, to), which);
    sum_r += before * ar + after * br;
    sum_g += before * ag + after * bg;
    sum_b += before * ab + after * bb;
    top_r = pick(top_r, qr, which);
    top_g = pick(top_g, qg, which);
    top_b = pick(top_b, qb, which);
    if (kSlopes != 0) {
        // As a point moves, what it sees in one direction moves along the surface: a change of radiance there acts as an edge
        // would, at its distance.
        vec4 turn = inversesqrt(1.0 + middle * middle) / max(depth, vec4(1e-6));
        vec4 weight = pick(vec4(0.0), turn, which);
        add_slopes(pr - qr, pg - qg, pb - qb, middle, kMoment != 0 ? weight * direction_of(middle) : weight);
        third += max(max(abs(pr - qr), abs(pg - qg)), abs(pb - qb)) * weight * weight * weight;
    }
}
