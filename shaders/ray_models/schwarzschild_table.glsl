/*---
label = "Schwarzschild, table"
summary = "Exact null orbits of a hole without spin, not marched: a table of how far round the hole each ray goes, and closed forms for the rest."
source = "own, after Bruneton 2020 (all orbits from one radius are one family); Carlson's R_F; addition theorem of Weierstrass' function"
slot = "ray_model"
rank = 3
kind = "closed"
space_time = "schwarzschild"
spins = false
exact = true
tilted_disk = true

[tables.orbit_table]
make = "blackhole_gl.physics.orbit_table:table"
of = ["camera.distance"]
constants = "blackhole_gl.physics.orbit_table:CONSTANTS"

[numbers.orbit_factors]  # from angular momentum to the table's coordinate
make = "blackhole_gl.physics.orbit_table:coordinate_factors"
of = ["camera.distance"]
type = "vec2"
---*/
#include "common/orbit_from_centre.glsl"
#include "common/disk_plane.glsl"

uniform sampler2D orbit_table;

// The angle swept to the ray's end; `ratio` = tan(ψ/2)/tan(ψ_c/2) is above 1 for a ray that escapes.
float swept_angle(float ratio) {
    float x = clamp(abs(ratio - 1.0), 5.9604645e-8, ratio > 1.0 ? 1e12 : 0.99999994);
    int bits = floatBitsToInt(x);
    int cell = bits >> ORBIT_CELL_BITS;
    float t = float(bits - (cell << ORBIT_CELL_BITS)) / float(1 << ORBIT_CELL_BITS) - 0.5;
    vec4 cubic = texelFetch(orbit_table, ivec2(cell - ORBIT_FIRST_CELL, ratio > 1.0 ? 1 : 0), 0);
    return cubic.x + t * (cubic.y + t * (cubic.z + t * cubic.w));
}

#if ORDERS > 0
// `radius` as (numerator, denominator); `node` is the unit vector of the crossing in the disk's plane; `onward` the unit vector that the ray turns to there; `state` is
// (u, du/dφ) there as good as the other sums allow. The orbit's equation knows the size of du/dφ better but beside a turning point, where it is a small root.
void add_kept(bool there, vec2 radius, vec2 node, vec3 onward, vec2 state, float root_kappa, inout Hits hits) {
    if (!there || radius.y <= 0.0 || radius.y * crossing_r_min >= radius.x) return;
    float r = radius.x / radius.y, u = 1.0 / r;
    float square = 1.0 - u * u * (1.0 - u) / (root_kappa * root_kappa), rate = state.y / root_kappa;
    float w_rate = square > 0.05 ? sqrt(square) * sign(rate) : rate;
    add_crossing(hits, r * node, Momentum(w_rate, (2.0 / root_kappa) * onward));
}

// The crossings lie at φ₀ + nπ, φ₀ where the orbit's plane meets the disk's first. The first is reached from the camera, the last from the
// ray's end, which holds all digits however near the critical curve; those between from the camera by quarter turns: the longer
// the way, the nearer orbit_on comes to 0/0 for a camera close to the horizon.
void add_crossings(RayStart start, vec3 across, vec2 end, float swept, bool escapes, float kappa, float root_kappa, inout Hits hits) {
    vec3 from_disk = in_disk_axes(start.n), aside = in_disk_axes(across);
    float tilt = length(vec2(from_disk.z, aside.z));
    float side = from_disk.z == 0.0 ? sign(aside.z) : sign(from_disk.z);  // a camera in the plane does not cross it where it is
    vec2 first = vec2(-aside.z * side, abs(from_disk.z)) / max(tilt, 1e-30);
    vec2 node = first.x * from_disk.xy + first.y * aside.xy;

    int half_turns = int(swept * 0.318309886);
    float flip = (half_turns & 1) == 0 ? 1.0 : -1.0;
    vec2 rest = flip * vec2(end.x * first.x + end.y * first.y, end.y * first.x - end.x * first.y);
    bool past = rest.y > 0.0;
    if (!past) rest = -rest;
    int count = tilt > 0.0 ? half_turns + (past ? 1 : 0) : 0;
    vec2 last = orbit_before_end(escapes, orbit_from_centre(rest, kappa), kappa, root_kappa);

    bool behind = first.x < 0.0;
    vec2 quarter_turn = orbit_from_centre(vec2(0.0, 1.0), kappa);
    vec2 camera = vec2(2.0 * start.w, clamp(start.w_rate, -1.0, 1.0) * root_kappa);
    vec2 base = behind ? orbit_state_on(camera, quarter_turn, kappa) : camera;
    vec2 further = orbit_from_centre(behind ? vec2(first.y, -first.x) : first, kappa);
    vec3 heading = first.x * across - first.y * start.n;
    float reach = 0.5 - 0.5 * first.x;
    bool outside = kappa * reach * reach * reach < CENTRE_REACH;
    vec2 radius = count == 1 && escapes ? last : orbit_on(base, further, kappa);
    add_kept(count > 0 && (outside || escapes), radius, node, heading, orbit_state_on(base, further, kappa), root_kappa, hits);
#if ORDERS > 1
    base = orbit_state_on(orbit_state_on(base, quarter_turn, kappa), quarter_turn, kappa);
    radius = count == 2 ? last : orbit_on(base, further, kappa);
    add_kept(count > 1, radius, -node, -heading, orbit_state_on(base, further, kappa), root_kappa, hits);
#endif
#if ORDERS > 2
    base = orbit_state_on(orbit_state_on(base, quarter_turn, kappa), quarter_turn, kappa);
    radius = count == 3 ? last : orbit_on(base, further, kappa);
    add_kept(count > 2, radius, node, heading, orbit_state_on(base, further, kappa), root_kappa, hits);
#endif
}
#endif

Hits trace_ray(RayStart start) {
    Hits hits = no_hits(start.lambda);
    hits.steps = 1;
    float momentum = length(start.n_rate);
    float root_kappa = 2.0 / max(momentum, 1e-10);
    float kappa = root_kappa * root_kappa;
    vec3 across = (0.5 * root_kappa) * start.n_rate;

    float cosine = clamp(start.w_rate, -1.0, 1.0);
    bool inward = cosine > 0.0;
    float ratio = (inward ? orbit_factors.x * momentum : orbit_factors.y * (1.0 - cosine)) / (inward ? 1.0 + cosine : momentum);
    bool escapes = ratio > 1.0;
    float swept = swept_angle(ratio);
    vec2 end = cos_sin(swept);

    hits.fate = escapes ? ESCAPED : CAPTURED;
    if (escapes) hits.direction = end.x * start.n + end.y * across;
#if ORDERS > 0
    add_crossings(start, across, end, swept, escapes, kappa, root_kappa, hits);
#endif
    return hits;
}
