// How many points one thread solves, and the solver's words for their numbers: `reals` are one number of each point. Four points lie in
// the components of vectors (what llvmpipe wants: one fetch of a piece serves four); one is a scalar, so that a GPU's thread needs a
// quarter of the registers and takes no branch for another point's sake.
#define EXACT_WIDTH 4

#if EXACT_WIDTH == 4

#define reals vec4
#define bools bvec4
#define ints ivec4
#define uints uvec4

bools lt(reals a, reals b) { return lessThan(a, b); }
bools le(reals a, reals b) { return lessThanEqual(a, b); }
bools gt(reals a, reals b) { return greaterThan(a, b); }
bools ge(reals a, reals b) { return greaterThanEqual(a, b); }
bools eq(reals a, reals b) { return equal(a, b); }
bools ne(reals a, reals b) { return notEqual(a, b); }
bools both(bools a, bools b) { return bvec4(a.x && b.x, a.y && b.y, a.z && b.z, a.w && b.w); }
bools either(bools a, bools b) { return bvec4(a.x || b.x, a.y || b.y, a.z || b.z, a.w || b.w); }
bools opposite(bools a) { return not(a); }
bool any_of(bools a) { return any(a); }
bool all_of(bools a) { return all(a); }
uints pick(uints no, uints yes, bools which) {
    return uvec4(which.x ? yes.x : no.x, which.y ? yes.y : no.y, which.z ? yes.z : no.z, which.w ? yes.w : no.w);
}
float first_of(reals a) { return a.x; }
// 1 for the point k, 0 for the others.
reals only(int k) { return vec4(equal(ivec4(0, 1, 2, 3), ivec4(k))); }

// Each point's own texel.
void fetch_each(samplerBuffer from, ints at, out reals x, out reals y, out reals z, out reals w) {
    vec4 t0 = texelFetch(from, at.x), t1 = texelFetch(from, at.y), t2 = texelFetch(from, at.z), t3 = texelFetch(from, at.w);
    x = vec4(t0.x, t1.x, t2.x, t3.x);
    y = vec4(t0.y, t1.y, t2.y, t3.y);
    z = vec4(t0.z, t1.z, t2.z, t3.z);
    w = vec4(t0.w, t1.w, t2.w, t3.w);
}

#else

#define reals float
#define bools bool
#define ints int
#define uints uint

bools lt(reals a, reals b) { return a < b; }
bools le(reals a, reals b) { return a <= b; }
bools gt(reals a, reals b) { return a > b; }
bools ge(reals a, reals b) { return a >= b; }
bools eq(reals a, reals b) { return a == b; }
bools ne(reals a, reals b) { return a != b; }
bools both(bools a, bools b) { return a && b; }
bools either(bools a, bools b) { return a || b; }
bools opposite(bools a) { return !a; }
bool any_of(bools a) { return a; }
bool all_of(bools a) { return a; }
reals pick(reals no, reals yes, bools which) { return which ? yes : no; }
uints pick(uints no, uints yes, bools which) { return which ? yes : no; }
float first_of(reals a) { return a; }
reals only(int k) { return 1.0; }

void fetch_each(samplerBuffer from, ints at, out reals x, out reals y, out reals z, out reals w) {
    vec4 t = texelFetch(from, at);
    x = t.x;
    y = t.y;
    z = t.z;
    w = t.w;
}

#endif
