// What directions weigh, how edges change the light, and the light of surfaces that reflect. Reads the state of
// the walk of glsl/exact_solve.comp.

reals normal_x, normal_y;  // of surfaces' points

// The integral of the cosine from the normal's right up to a key; behind the surface it does not change.
reals cosine_up_to(reals key) {
    reals x = axis.x + side.x * key, y = axis.y + side.y * key;
    reals sine = (normal_x * y - normal_y * x) * inversesqrt(1.0 + key * key);
    bools front = gt(normal_x * x + normal_y * y, reals(0.0));
    return pick(sign(sine), sine, front);
}

// The direction's component that is asked for, at a key.
reals direction_of(reals key) {
    float along = kMoment == 1 ? axis.x : axis.y;
    float across = kMoment == 1 ? side.x : side.y;
    return (along + across * key) * inversesqrt(1.0 + key * key);
}

// What directions between two keys weigh.
reals weight_of(reals a, reals b) {
    if (kNodes != 0) return max(cosine_up_to(b) - cosine_up_to(a), reals(0.0));
    reals angle = arctangent((b - a) / (1.0 + b * a));
    if (kMoment == 0) return angle;
    // The integral of a unit vector is the chord: 2 sin(angle / 2) along the middle. The angle is within a sector.
    reals h2 = 0.25 * angle * angle;
    reals chord = angle * (1.0 - h2 * (1.0 / 6.0 - h2 * (1.0 / 120.0 - h2 / 5040.0)));
    reals ia = inversesqrt(1.0 + a * a), ib = inversesqrt(1.0 + b * b);
    reals ahead = ia + ib, aside = a * ia + b * ib;
    float along = kMoment == 1 ? axis.x : axis.y;
    float across = kMoment == 1 ? side.x : side.y;
    return chord * (along * ahead + across * aside) * inversesqrt(max(ahead * ahead + aside * aside, reals(1e-30)));
}

int kind_of(float entry) { return entry < float(first_disc) ? 0 : entry < float(first_arc) ? 1 : entry < float(first_ellipse) ? 2 : 3; }

void add_slopes(reals jr, reals jg, reals jb, reals key, reals weight) {
    reals inverse = inversesqrt(1.0 + key * key);
    reals along = (axis.y + side.y * key) * inverse * weight;
    reals across = (axis.x + side.x * key) * inverse * weight;
    slope_x_r += jr * along;
    slope_x_g += jg * along;
    slope_x_b += jb * along;
    slope_y_r -= jr * across;
    slope_y_g -= jg * across;
    slope_y_b -= jb * across;
}

// The light of surfaces from `from` to `to`; top_r, top_g, top_b become their radiance at `to`.
void gather_surfaces(bools which, reals to) {
    reals entry = max(top, reals(0.0));
    reals middle = reals(0.0), depth = reals(0.0);
    reals ar = reals(0.0), ag = reals(0.0), ab = reals(0.0), br = reals(0.0), bg = reals(0.0), bb = reals(0.0);
    reals pr = reals(0.0), pg = reals(0.0), pb = reals(0.0), qr = reals(0.0), qg = reals(0.0), qb = reals(0.0);
    // One point after another: the program stays small, and the driver has less to compile.
    for (int k = 0; k < EXACT_WIDTH; ++k) {
        reals lane = only(k);
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
    reals before = pick(reals(0.0), weight_of(from, middle), which);
    reals after = pick(reals(0.0), weight_of(middle, to), which);
    sum_r += before * ar + after * br;
    sum_g += before * ag + after * bg;
    sum_b += before * ab + after * bb;
    top_r = pick(top_r, qr, which);
    top_g = pick(top_g, qg, which);
    top_b = pick(top_b, qb, which);
    if (kSlopes != 0) {
        // As a point moves, what it sees in one direction moves along the surface: a change of radiance there acts as an edge
        // would, at its distance.
        reals turn = inversesqrt(1.0 + middle * middle) / max(depth, reals(1e-6));
        reals weight = pick(reals(0.0), turn, which);
        add_slopes(pr - qr, pg - qg, pb - qb, middle, kMoment != 0 ? weight * direction_of(middle) : weight);
        third += max(max(abs(pr - qr), abs(pg - qg)), abs(pb - qb)) * weight * weight * weight;
    }
}
