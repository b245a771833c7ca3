/*---
label = "Schwarzschild, Binet"
summary = "Exact null orbits of a hole without spin, one unknown in the orbit's plane: u'' + u = (3/2) u². Radial rays are no special case."
source = "an orbital-plane renderer (docs/sources.md); Binet's equation"
slot = "ray_model"
rank = 5
kind = "differential"
marches_in = "mino"
step_control = "curvature"
space_time = "schwarzschild"
spins = false
second_order = true
exact = true
tilted_disk = true
tells_time = true
---*/
// Units M = 1. With φ = √K τ the equation reads w'' = K w (3 w − 1): the same steps in φ, and still a sensible equation where b = √K is 0
// and φ stands still. The place is n cos φ + aside sin φ, so that disk crossings lie at known φ.

struct Orbit {
    float k;      // b² in M²
    float scale;  // 1/√(K + 1), the parameter of about one radian
};

struct State {
    float w;
    float w_rate;
    float angle;
    float b;     // constant, as are n and aside: the angle's rate
    vec3 n;      // where the march began, and at right angles to it
    vec3 aside;
#if RAYS_LIGHT_TRAVEL
    float time;  // since the camera, in M
#endif
};

#include "common/radial_mino.glsl"
#include "common/ray_time.glsl"

Orbit ray_orbit(RayStart start) {
    float k = dot(start.n_rate, start.n_rate);
    return Orbit(k, inversesqrt(k + 1.0));
}

State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
    float b = sqrt(orbit.k);
    return State(start.w, start.w_rate, 0.0, b, start.n, b > 0.0 ? start.n_rate / b : vec3(0.0) AND_TIME(0.0));
}

State ray_rhs(Orbit orbit, State s) {
    return State(s.w_rate, orbit.k * s.w * (3.0 * s.w - 1.0), s.b, s.b, s.n, s.aside AND_TIME(s.time));
}

State state_step(State s, float h, State k) {
    return State(s.w + h * k.w, s.w_rate + h * k.w_rate, s.angle + h * k.angle, s.b, s.n, s.aside AND_TIME(s.time));
}

State state_kick(State s, float h, State k) {
    return State(s.w, s.w_rate + h * k.w_rate, s.angle, s.b, s.n, s.aside AND_TIME(s.time));
}

State state_push(State s, float h2, State k) {
    return State(s.w + h2 * k.w_rate, s.w_rate, s.angle, s.b, s.n, s.aside AND_TIME(s.time));
}

State state_drift(State s, float h) {
    return State(s.w + h * s.w_rate, s.w_rate, s.angle + h * s.b, s.b, s.n, s.aside AND_TIME(s.time));
}

float state_difference(Orbit orbit, State a, State b) {
    return abs(a.w - b.w) / orbit.scale + abs(a.w_rate - b.w_rate) + abs(a.angle - b.angle);
}

#if RAYS_LIGHT_TRAVEL
// With a = 0, c₃ = 3K and c₄ = 0.
TimeConstants time_constants(Orbit orbit) {
    return TimeConstants(3.0 * orbit.k, 0.0, 0.0, 1.0);
}

TimeEnd time_end(Orbit orbit, State s) {
    return TimeEnd(vec2(s.w, 0.0), vec2(s.w_rate, 0.0), vec2(ray_rhs(orbit, s).w_rate, 0.0));
}

#define RAY_QUADRATURE ray_time
void ray_time(Orbit orbit, State a, float h, inout State b) {
    b.time = a.time + step_time(time_constants(orbit), time_end(orbit, a), time_end(orbit, b), h);
}

#include "common/mino_delay.glsl"
#endif

// A whole number of 2⁻¹⁶ radians, so that the angle's sums are exact: else each step is rounded the same way, and many steps add up.
float ray_plain_step(Orbit orbit, State s) {
    float h = plan_step_angle * orbit.scale;
    float turn = floor(h * s.b * 65536.0 + 0.5) / 65536.0;
    return turn > 1e-3 ? turn / s.b : h;
}

void ray_finish(Orbit orbit, State s, inout Hits hits) {
    vec2 turn = cos_sin(s.angle - s.b * s.w / s.w_rate);  // less what the root left over
    hits.direction = normalize(turn.x * s.n + turn.y * s.aside);
}

// w'² = 1 − K w² (1 − 2 w), against the sizes of its terms.
#define RAY_DRIFT ray_drift
float ray_drift(Orbit orbit, State s) {
    float bend = orbit.k * s.w * s.w;
    return abs(s.w_rate * s.w_rate - 1.0 + bend * (1.0 - 2.0 * s.w)) / (1.0 + bend * (1.0 + 2.0 * abs(s.w)));
}

float ray_height(State s) {
    return dot(cos_sin(s.angle), vec2(s.n.z, s.aside.z));
}

float ray_height_rate(State s) {
    return s.b * dot(cos_sin(s.angle), vec2(s.aside.z, -s.n.z));
}

float ray_elevation(State s) {
    return ray_height(s);
}

Path ray_path(Orbit orbit, State s) {
    vec2 turn = cos_sin(s.angle);
    return Path(vec4(turn.x * s.n + turn.y * s.aside, 2.0 * s.w), vec4(s.b * (turn.x * s.aside - turn.y * s.n), 2.0 * s.w_rate), vec2(0.0) AND_TIME(path_time(orbit, s)));
}

Momentum ray_momentum(Orbit orbit, State s) {
    vec2 turn = cos_sin(s.angle);
    return Momentum(s.w_rate, s.b * (turn.x * s.aside - turn.y * s.n));
}

float ray_affine_rate(Orbit orbit, State s) {
    return 0.5 / (s.w * s.w);
}

vec2 ray_plane_point(State s) {
    vec2 turn = cos_sin(s.angle);
    return normalize(turn.x * s.n.xy + turn.y * s.aside.xy) * (0.5 / s.w);
}
