// Ray pieces: radiance met on the way, and the share of what comes from its end that arrives. A texture of them holds the radiance
// in rgb and the share in a; where channels differ (media), its second half holds the shares in rgb.
#include "lib/hrc_media.glsl"

struct Piece {
    vec3 light;
    vec3 through;
};

// The near piece, then the far one.
Piece after(Piece near, Piece far) { return Piece(near.light + near.through * far.light, near.through * far.through); }

Piece mixed(Piece a, Piece b, float share) { return Piece(mix(a.light, b.light, share), mix(a.through, b.through, share)); }

void store_piece(ivec2 at, Piece piece) {
    imageStore(pieces_image, at, vec4(piece.light, piece.through.r));
    if (kHrcMedia != 0) imageStore(pieces_image, at + ivec2(0, imageSize(pieces_image).y / 2), vec4(piece.through, 1.0));
}

// Quotient by the jobs of a plane; whole numbers this small divide exactly.
int plane_of(int job) { return int((float(job) + 0.5) * params.per_job); }

// A piece of the level below; what begins outside of the lattice meets nothing.
Piece lower_piece(int plane, int ray, int row) {
    int inside_plane = min(plane, params.lower_planes - 1);
    int inside_row = clamp(row, 0, params.rows - 1);
    ivec2 at = ivec2(inside_row, inside_plane * params.lower_rays + ray);
    vec4 piece = imageLoad(lower_image, at);
    vec3 through = vec3(piece.a);
    if (kHrcMedia != 0) through = imageLoad(lower_image, at + ivec2(0, imageSize(lower_image).y / 2)).rgb;
    if (plane == inside_plane && row == inside_row) return Piece(piece.rgb, through);
    return Piece(vec3(0.0), vec3(1.0));
}
