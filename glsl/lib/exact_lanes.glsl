// Threads that share a job of the solver, and how what they gather is added up (kExactLanes; reads and writes the sums of the points).
// Sectors know nothing of one another, so that threads may share them.
shared vec4 parts[kExactSolveGroupX * kExactLanes];
shared uvec4 part_signatures[kExactSolveGroupX];

int lane() { return kExactLanes > 1 ? int(gl_LocalInvocationID.y) : 0; }

// The sum over the lanes of a job, in their order: the same each time. For the first of them.
vec4 of_all_lanes(vec4 part) {
    int job = int(gl_LocalInvocationID.x);
    parts[lane() * kExactSolveGroupX + job] = part;
    barrier();
    vec4 sum = part;
    if (lane() == 0)
        for (int i = 1; i < kExactLanes; ++i) sum += parts[i * kExactSolveGroupX + job];
    barrier();
    return sum;
}

void add_up_lanes() {
    sum_r = of_all_lanes(sum_r);
    sum_g = of_all_lanes(sum_g);
    sum_b = of_all_lanes(sum_b);
    if (kSlopes == 0) return;
    slope_x_r = of_all_lanes(slope_x_r);
    slope_x_g = of_all_lanes(slope_x_g);
    slope_x_b = of_all_lanes(slope_x_b);
    slope_y_r = of_all_lanes(slope_y_r);
    slope_y_g = of_all_lanes(slope_y_g);
    slope_y_b = of_all_lanes(slope_y_b);
    third = of_all_lanes(third);
    int job = int(gl_LocalInvocationID.x);
    if (lane() == 0) part_signatures[job] = uvec4(0u);
    barrier();
    atomicAdd(part_signatures[job].x, signature.x);
    atomicAdd(part_signatures[job].y, signature.y);
    atomicAdd(part_signatures[job].z, signature.z);
    atomicAdd(part_signatures[job].w, signature.w);
    barrier();
    signature = part_signatures[job];
}
