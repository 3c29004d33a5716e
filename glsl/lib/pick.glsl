// `yes` where `which` holds, else `no`. In place of mix(no, yes, which), which one driver (NVIDIA 5xx) computes as a weighted sum in
// larger programs: wrong by parts in ten thousand of a far key that is not picked, and not a number beside an infinite one.
vec2 pick(vec2 no, vec2 yes, bvec2 which) { return vec2(which.x ? yes.x : no.x, which.y ? yes.y : no.y); }
vec3 pick(vec3 no, vec3 yes, bvec3 which) { return vec3(which.x ? yes.x : no.x, which.y ? yes.y : no.y, which.z ? yes.z : no.z); }
vec4 pick(vec4 no, vec4 yes, bvec4 which) {
    return vec4(which.x ? yes.x : no.x, which.y ? yes.y : no.y, which.z ? yes.z : no.z, which.w ? yes.w : no.w);
}
