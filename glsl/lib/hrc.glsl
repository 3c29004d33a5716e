// Ray pieces: radiance met on the way in rgb, transmittance in a.

// The near piece, then the far one.
vec4 after(vec4 near, vec4 far) { return vec4(near.rgb + near.a * far.rgb, near.a * far.a); }

// Quotient by the jobs of a plane; whole numbers this small divide exactly.
int plane_of(int job) { return int((float(job) + 0.5) * params.per_job); }

// A piece of the level below; what begins outside of the lattice meets nothing.
vec4 lower_piece(int plane, int ray, int row) {
    int inside_plane = min(plane, params.lower_planes - 1);
    int inside_row = clamp(row, 0, params.rows - 1);
    vec4 piece = imageLoad(lower_image, ivec2(inside_row, inside_plane * params.lower_rays + ray));
    return plane == inside_plane && row == inside_row ? piece : vec4(0.0, 0.0, 0.0, 1.0);
}
