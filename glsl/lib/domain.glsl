// Where a ray leaves the domain.
const float kNeverLeaves = 1e30;

// Distance along the ray at which it leaves the box (x0 y0 x1 y1); negative when it starts outside.
float exit_distance(vec2 p, vec2 d, vec4 box) {
    vec2 lo = (box.xy - p) / d;
    vec2 hi = (box.zw - p) / d;
    vec2 leave = max(lo, hi);
    // A component of 0 never leaves through its sides.
    if (d.x == 0.0) leave.x = kNeverLeaves;
    if (d.y == 0.0) leave.y = kNeverLeaves;
    return min(leave.x, leave.y);
}
