// What the models that march in Cartesian space share: state, start, fate, and the way to and from infinity.
// x in r_s, v = dx/dσ with the affine parameter σ scaled so that E = 1 (where G = 1). The world is the marched space turned about the spin axis
// by the twist. A model gives
//     float ray_twist_strength()    twist = −strength · ∫ dσ/r³
//     float ray_newtonian_pull()    M of a force −M x/r³ beside the relativistic one; 0 where light is light
//     float ray_drag()              k of a force −(k/r³) v × ẑ; 0 for central forces
#include "common/central_orbit.glsl"

struct State {
    vec3 x;
    vec3 v;
    float twist;
};

Orbit ray_orbit(RayStart start) {
    float h2 = 0.25 * dot(start.n_rate, start.n_rate);
    float u = 2.0 * start.w;
    // v² at the camera is 1 + h²u³ in the frame of a static observer; the viewers with a Newtonian pull start with |v| = 1.
    float frame = ray_newtonian_pull() == 0.0 ? 1.0 : 0.0;
    return Orbit(h2, 1.0 + (frame - hole_gravity_strength) * h2 * u * u * u - 2.0 * hole_gravity_strength * ray_newtonian_pull() * u);
}

vec2 twisted(vec2 point, float twist) {
    return ray_twist_strength() == 0.0 && ray_drag() == 0.0 ? point : rotate(point, cos_sin(twist));
}

// At radius r on a leg that is followed outwards towards `onward`; the ray runs along it (sense 1) or against it (−1).
Momentum leg_momentum(Orbit orbit, float r, vec3 onward, float twist, float sense) {
    return Momentum(-sense * radial_speed(orbit, 1.0 / r), 2.0 * sense * sqrt(orbit.h2) * vec3(twisted(onward.xy, twist), onward.z));
}

void add_leg_crossing(Orbit orbit, vec3 n, vec3 across, float u, float u_end, float twist, float sense, inout Hits hits) {
#if ORDERS > 0
    vec3 onward;
    vec4 found = leg_crossing(orbit, n, across, u, u_end, onward);
    float turn = twist - sense * ray_twist_strength() * found.z;
    if (found.w > 0.0) add_crossing(hits, twisted(found.xy, turn), leg_momentum(orbit, length(found.xy), onward, turn, sense));
#endif
}

// A ray that comes in from afar starts its march where it is near, with what it crossed on the way there: fewer steps, and no
// rounding of a place that is many horizons away.
State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
    float h = sqrt(orbit.h2);
    float u_far = 2.0 * start.w;
    float u = 1.0 / max(march_bound, 2.0 * h);
    if (u_far >= u || start.w_rate <= 0.0) return State(start.n / u_far, start.w * start.n_rate - start.w_rate * start.n, 0.0);
    vec3 aside = h > 0.0 ? start.n_rate * (0.5 / h) : vec3(0.0);
    vec2 leg = orbit_leg(orbit, u, u_far);
    vec3 n = turned(start.n, aside, leg.x);
    vec3 across = turned(aside, -start.n, leg.x);
    float twist = -ray_twist_strength() * leg.y;
    if (disk_height(start.n) != 0.0) add_leg_crossing(orbit, n, -across, u, u_far, twist, -1.0, hits);
    vec3 v = h * u * across - radial_speed(orbit, u) * n;
    // The drag of the way in, to first order: it has turned the ray about the axis and, over that length of way, moved it aside.
    vec3 aside_of_axis = ray_drag() * vec3(-v.y, v.x, 0.0);
    return State(n / u + (0.5 * (u - u_far) * (u - u_far) / u) * aside_of_axis, v + leg.y * aside_of_axis, twist);
}

State ray_rhs(Orbit orbit, State s) {
    float u2 = 1.0 / dot(s.x, s.x);
    float u3 = u2 * sqrt(u2);
    float pull = hole_gravity_strength * (1.5 * orbit.h2 * u2 + ray_newtonian_pull()) * u3;
    vec3 force = -pull * s.x;
    force.xy += ray_drag() * u3 * vec2(-s.v.y, s.v.x);
    return State(s.v, force, -ray_twist_strength() * u3);
}

State state_step(State s, float h, State k) {
    return State(s.x + h * k.x, s.v + h * k.v, s.twist + h * k.twist);
}

State state_kick(State s, float h, State k) {
    return State(s.x, s.v + h * k.v, s.twist + h * k.twist);
}

State state_push(State s, float h2, State k) {
    return State(s.x + h2 * k.v, s.v, s.twist);
}

State state_drift(State s, float h) {
    return State(s.x + h * s.v, s.v, s.twist);
}

float state_difference(Orbit orbit, State a, State b) {
    return distance(a.x, b.x) / length(b.x) + distance(a.v, b.v) + abs(a.twist - b.twist);
}

float ray_radius(State s) {
    return length(s.x);
}

// Factor by which a step of σ is shortened, so that its length stays what was asked. Rays from afar have |v| < 3 down to the horizon and keep
// theirs. Faster ones start from a camera just above it, or fall further, which only the artistic horizon sizes let them.
float ray_slowdown(State s) {
    return 3.0 / max(3.0, length(s.v));
}

float ray_plain_step(Orbit orbit, State s) {
    return plan_step_length * ray_radius(s) / 3.0 * ray_slowdown(s);
}

float ray_longest_step(Orbit orbit, State s) {
    return 0.5 * ray_radius(s);
}

int ray_fate(Orbit orbit, State s) {
    float r2 = dot(s.x, s.x);
    float inner = 0.5 * hole_w_factors.x * hole_horizon_size;
    if (r2 < inner * inner) return CAPTURED;
    float outward = dot(s.x, s.v);
    bool free = ray_newtonian_pull() == 0.0 || orbit.e2 > 0.0;  // a Newtonian pull can hold what has |v| = 1 close to the hole
    bool leaves = free && outward > 0.0 && outward * outward > OUTWARD_COSINE * OUTWARD_COSINE * r2 * dot(s.v, s.v);
    return leaves && r2 > march_bound * march_bound ? ESCAPED : UNRESOLVED;
}

float ray_end(Orbit orbit, State a, State b, float h) {
    return 1.0;
}

void ray_finish(Orbit orbit, State s, inout Hits hits) {
    float u = inversesqrt(dot(s.x, s.x));
    vec3 n = s.x * u;
    vec3 aside = s.v - dot(s.v, n) * n;
    float speed = length(aside);
    vec3 across = speed > 0.0 ? aside / speed : vec3(0.0);
    if (ray_drag() != 0.0) orbit.h2 = speed * speed / (u * u);  // a side force has changed it
    vec2 leg = orbit_leg(orbit, u, 0.0);
    add_leg_crossing(orbit, n, across, u, 0.0, s.twist, 1.0, hits);
    vec3 escape = turned(n, across, leg.x);
    hits.direction = normalize(vec3(twisted(escape.xy, s.twist + (ray_drag() - ray_twist_strength()) * leg.y), escape.z));
}

// |x × v|² = h² and v² = E² + G u (h²u² + 2 M), both central and both lost to drag.
#define RAY_DRIFT ray_drift
float ray_drift(Orbit orbit, State s) {
    if (ray_drag() != 0.0) return -1.0;
    float u = inversesqrt(dot(s.x, s.x));
    vec3 turning = cross(s.x, s.v);
    float square = orbit.e2 + hole_gravity_strength * u * (orbit.h2 * u * u + 2.0 * ray_newtonian_pull());
    return max(abs(dot(turning, turning) - orbit.h2) / max(orbit.h2, 1.0), abs(dot(s.v, s.v) - square) / square);
}

float ray_height(State s) {
    return s.x.z;
}

float ray_height_rate(State s) {
    return s.v.z;
}

float ray_elevation(State s) {
    return s.x.z / ray_radius(s);
}

Path ray_path(Orbit orbit, State s) {
    float u2 = 1.0 / dot(s.x, s.x);
    return Path(vec4(s.x, 1.0), vec4(s.v, 0.0), vec2(s.twist, -ray_twist_strength() * u2 * sqrt(u2)));
}

Momentum ray_momentum(Orbit orbit, State s) {
    Momentum found = momentum_at(s.x, s.v);
    found.n_rate.xy = twisted(found.n_rate.xy, s.twist);
    return found;
}

float ray_affine_rate(Orbit orbit, State s) {
    return 1.0;
}

vec2 ray_plane_point(State s) {
    return twisted(s.x.xy, s.twist);
}
