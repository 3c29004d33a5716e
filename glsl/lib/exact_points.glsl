// Which points a thread of the solver takes, and what becomes of what they gather (reads and writes the sums of exact_solve.comp).
// A job is up to four points of one tile. With kExactLanes, threads share a point's sectors, which know nothing of one another.

ivec2 local_point(int first, int index, int count) {
    int place = int(texelFetch(points, first + min(index, count - 1)).r);
    return ivec2(place & 0xff, place >> 8);
}

// Whether a point is inside of a shape. Without shapes the distance is a single texel.
bool is_solid(ivec2 pixel) {
    return texelFetch(distance_texture, min(pixel + params.border, textureSize(distance_texture, 0) - 1), 0).r <= 0.0;
}

ivec2 pixel_of(ivec2 place) { return min(place + ivec2(0, params.first_row), params.canvas - 1); }

ivec2 origin_of(int tile) {
    int row = tile / params.tiles.x;
    return ivec2(tile - row * params.tiles.x, row) * kExactTile;
}

ivec2 image_of(float element) { return ivec2(int(element) % kExactNodeRow, int(element) / kExactNodeRow); }

#if EXACT_WIDTH == 4

ivec2 p0, p1, p2, p3;  // where they are in the images; the last of a tile is repeated

int lane() { return 0; }

int job_index() { return int(gl_GlobalInvocationID.x) + params.origin.y * params.extent.x; }

// Of the points that a tile asks for; returns which are inside of shapes.
bools find_points(int tile, int first, int count) {
    ivec2 origin = origin_of(tile);
    int at = params.first_point + tile * params.tile_points;
    p0 = origin + local_point(at, first, count);
    p1 = origin + local_point(at, first + 1, count);
    p2 = origin + local_point(at, first + 2, count);
    p3 = origin + local_point(at, first + 3, count);
    ivec2 x0 = pixel_of(p0), x1 = pixel_of(p1), x2 = pixel_of(p2), x3 = pixel_of(p3);
    px = vec4(x0.x, x1.x, x2.x, x3.x) + 0.5;
    py = vec4(x0.y, x1.y, x2.y, x3.y) + 0.5;
    return bvec4(is_solid(x0), is_solid(x1), is_solid(x2), is_solid(x3));
}

// Of the elements of surfaces.
void find_nodes(int first) {
    vec4 n0 = texelFetch(nodes, 2 * first), n1 = texelFetch(nodes, 2 * first + 2), n2 = texelFetch(nodes, 2 * first + 4), n3 = texelFetch(nodes, 2 * first + 6);
    px = vec4(n0.x, n1.x, n2.x, n3.x);
    py = vec4(n0.y, n1.y, n2.y, n3.y);
    normal_x = vec4(n0.z, n1.z, n2.z, n3.z);
    normal_y = vec4(n0.w, n1.w, n2.w, n3.w);
    p0 = image_of(texelFetch(nodes, 2 * first + 1).r);
    p1 = image_of(texelFetch(nodes, 2 * first + 3).r);
    p2 = image_of(texelFetch(nodes, 2 * first + 5).r);
    p3 = image_of(texelFetch(nodes, 2 * first + 7).r);
}

void leave_out() {}

int sectors_done() { return params.continues != 0 ? int(imageLoad(slope_y_image, p0).a) : 0; }

// The sums go on where they were: in how many dispatches they are made shows in no digit.
void load() {
    vec4 v0 = imageLoad(value_image, p0), v1 = imageLoad(value_image, p1), v2 = imageLoad(value_image, p2), v3 = imageLoad(value_image, p3);
    sum_r = vec4(v0.r, v1.r, v2.r, v3.r);
    sum_g = vec4(v0.g, v1.g, v2.g, v3.g);
    sum_b = vec4(v0.b, v1.b, v2.b, v3.b);
    signature = uvec4(v0.a, v1.a, v2.a, v3.a);
    v0 = imageLoad(slope_x_image, p0);
    v1 = imageLoad(slope_x_image, p1);
    v2 = imageLoad(slope_x_image, p2);
    v3 = imageLoad(slope_x_image, p3);
    slope_x_r = vec4(v0.r, v1.r, v2.r, v3.r);
    slope_x_g = vec4(v0.g, v1.g, v2.g, v3.g);
    slope_x_b = vec4(v0.b, v1.b, v2.b, v3.b);
    third = vec4(v0.a, v1.a, v2.a, v3.a);
    v0 = imageLoad(slope_y_image, p0);
    v1 = imageLoad(slope_y_image, p1);
    v2 = imageLoad(slope_y_image, p2);
    v3 = imageLoad(slope_y_image, p3);
    slope_y_r = vec4(v0.r, v1.r, v2.r, v3.r);
    slope_y_g = vec4(v0.g, v1.g, v2.g, v3.g);
    slope_y_b = vec4(v0.b, v1.b, v2.b, v3.b);
}

// What a point has gathered: sums while it is not done, means then.
void store_one(ivec2 point, int done, vec3 sum, uint seen, vec4 x, vec3 y) {
    float whole = done < params.sectors || kNodes != 0 ? 1.0 : kTwoPi;
    imageStore(value_image, point, vec4(sum / whole, float(seen & 0xffffffu)));
    imageStore(slope_x_image, point, x / whole);
    imageStore(slope_y_image, point, vec4(y / whole, float(done)));
}

void store(int done) {
    store_one(p0, done, vec3(sum_r.x, sum_g.x, sum_b.x), signature.x, vec4(slope_x_r.x, slope_x_g.x, slope_x_b.x, third.x), vec3(slope_y_r.x, slope_y_g.x, slope_y_b.x));
    if (p1 != p0) store_one(p1, done, vec3(sum_r.y, sum_g.y, sum_b.y), signature.y, vec4(slope_x_r.y, slope_x_g.y, slope_x_b.y, third.y), vec3(slope_y_r.y, slope_y_g.y, slope_y_b.y));
    if (p2 != p1) store_one(p2, done, vec3(sum_r.z, sum_g.z, sum_b.z), signature.z, vec4(slope_x_r.z, slope_x_g.z, slope_x_b.z, third.z), vec3(slope_y_r.z, slope_y_g.z, slope_y_b.z));
    if (p3 != p2) store_one(p3, done, vec3(sum_r.w, sum_g.w, sum_b.w), signature.w, vec4(slope_x_r.w, slope_x_g.w, slope_x_b.w, third.w), vec3(slope_y_r.w, slope_y_g.w, slope_y_b.w));
}

#else

const int kGroupPoints = kExactSolveThreads / kExactLanes;

shared uvec4 parts[kExactSolveThreads];

ivec2 place;         // in the images
bool there = false;  // is this point

// Neighbouring threads are the same lane of neighbouring points: they ask the same pieces.
int lane() { return int(gl_LocalInvocationIndex) / kGroupPoints; }

int point_of_group() { return int(gl_LocalInvocationIndex) % kGroupPoints; }

int job_index() { return int(gl_WorkGroupID.x) * kExactSolveGroupX + point_of_group() / 4; }

bool find_points(int tile, int first, int count) {
    int index = first + point_of_group() % 4;
    there = index < count;
    place = origin_of(tile) + local_point(params.first_point + tile * params.tile_points, index, count);
    ivec2 pixel = pixel_of(place);
    px = float(pixel.x) + 0.5;
    py = float(pixel.y) + 0.5;
    return !there || is_solid(pixel);
}

// The last node of a tile is repeated in its job.
void find_nodes(int first) {
    int node = 2 * (first + point_of_group() % 4);
    there = true;
    vec4 at = texelFetch(nodes, node);
    px = at.x;
    py = at.y;
    normal_x = at.z;
    normal_y = at.w;
    place = image_of(texelFetch(nodes, node + 1).r);
}

void leave_out() { there = false; }

int sectors_done() { return 0; }
void load() {}

// Adds up what the lanes of a point gathered, in their order: the same each time. The first of them stores it.
void store(int done) {
    int from = point_of_group() * kExactLanes, at = from + lane();
    float share = kNodes == 0 ? kTwoPi : 1.0;
    bool stores = there && lane() == 0;
    parts[at] = uvec4(floatBitsToUint(vec3(sum_r, sum_g, sum_b)), signature);
    barrier();
    if (stores) {
        vec3 sum = vec3(0.0);
        uint seen = 0u;
        for (int i = from; i < from + kExactLanes; ++i) {
            sum += uintBitsToFloat(parts[i].xyz);
            seen += parts[i].w;
        }
        imageStore(value_image, place, vec4(sum / share, float(seen & 0xffffffu)));
    }
    if (kSlopes == 0) return;
    barrier();
    parts[at] = floatBitsToUint(vec4(slope_x_r, slope_x_g, slope_x_b, third));
    barrier();
    if (stores) {
        vec4 sum = vec4(0.0);
        for (int i = from; i < from + kExactLanes; ++i) sum += uintBitsToFloat(parts[i]);
        imageStore(slope_x_image, place, sum / share);
    }
    barrier();
    parts[at] = floatBitsToUint(vec4(slope_y_r, slope_y_g, slope_y_b, 0.0));
    barrier();
    if (stores) {
        vec3 sum = vec3(0.0);
        for (int i = from; i < from + kExactLanes; ++i) sum += uintBitsToFloat(parts[i].xyz);
        imageStore(slope_y_image, place, vec4(sum / share, float(done)));
    }
}

#endif
