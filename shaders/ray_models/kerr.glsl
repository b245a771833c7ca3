/*---
label = "Kerr"
summary = "Exact null geodesics of a spinning hole, in Mino time on the sphere of directions: no poles, no turning points."
source = "Carter 1968; Mino 2003; polynomial form in w = M/r and a unit vector (docs/physics.md)"
slot = "ray_model"
rank = 1
kind = "differential"
marches_in = "mino"
step_control = "mino"
space_time = "kerr"
spins = true
second_order = true
exact = true
tilted_disk = true
tells_time = true
crosses_horizon = true

[numbers.camera_lag]  # of the ingoing azimuth behind φ, where the camera is
make = "blackhole_gl.physics.observer_frames:ingoing_lag"
of = ["camera.distance", "hole.spin"]
---*/
// w'' = c₂w + c₃w² + c₄w³,  n'' = −(K + 2a²n_z²)n + a²n_z ẑ,  twist' = −a w (2 − aλw)/((1 − w r₊)(1 − w r₋)).
// Units M = 1. The world direction is n turned about the spin axis by the twist.
// Without HOLE_SPINS there is none, which spares what looks along ways its turns: a tenth of a ray that seeks a thing.
#if HOLE_SPINS
#define RAY_SPIN hole_spin
#else
#define RAY_SPIN 0.0
#endif

struct Orbit {
    vec3 c;        // c₂, c₃, c₄
    float k;       // K = η + λ²
    float a_lambda;
    float drag;    // −a, or a for negative energy
    float scale;   // 1/√(K + 1), the Mino time of about one radian
#if CAMERA_FALLS || RAYS_LIGHT_TRAVEL
    float energy;  // its sign; 0 for light that has never been outside
#endif
};

struct State {
    float w;
    float w_rate;
    vec3 n;
    vec3 n_rate;
    float twist;
#if RAYS_LIGHT_TRAVEL
    float time;    // since the camera, in M
#endif
};

#include "common/radial_mino.glsl"
#include "common/ray_time.glsl"

Orbit ray_orbit(RayStart start) {
    float a = RAY_SPIN;
    float k = dot(start.n_rate, start.n_rate) - a * a * start.n.z * start.n.z;
    float eta = k - start.lambda * start.lambda;
    vec3 c = vec3(a * a - k, 3.0 * (k - a * (2.0 * start.lambda - a)), -2.0 * a * a * eta);
#if CAMERA_FALLS
    // From inside, all light leads out to the horizon if traced backwards. What has come in through it has P = (r² + a²)E − aL > 0 there.
    bool came_in = start.w * hole_w_factors.x < 1.0 || start.energy * (2.0 * hole_w_factors.x - a * start.lambda) > 0.0;
    return Orbit(c, k, a * start.lambda, -a * start.energy, inversesqrt(max(k, 0.0) + 1.0), came_in ? start.energy : 0.0);
#else
    return Orbit(c, k, a * start.lambda, -a * start.energy, inversesqrt(max(k, 0.0) + 1.0) AND_TIME(start.energy));
#endif
}

State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
#if CAMERA_FALLS
    return State(start.w, start.w_rate, start.n, orbit.energy == 0.0 ? vec3(0.0) : start.n_rate, -camera_lag AND_TIME(0.0));  // what never was outside crosses nothing
#else
    return State(start.w, start.w_rate, start.n, start.n_rate, 0.0 AND_TIME(0.0));
#endif
}

State ray_rhs(Orbit orbit, State s) {
    float a = RAY_SPIN;
    float w_force = s.w * (orbit.c.x + s.w * (orbit.c.y + s.w * orbit.c.z));
    float a2_nz = a * a * s.n.z;
    vec3 n_force = -(orbit.k + 2.0 * a2_nz * s.n.z) * s.n;
    n_force.z += a2_nz;
    return State(s.w_rate, w_force, s.n_rate, n_force, 0.0 AND_TIME(0.0));
}

State state_step(State s, float h, State k) {
    return State(s.w + h * k.w, s.w_rate + h * k.w_rate, s.n + h * k.n, s.n_rate + h * k.n_rate, s.twist AND_TIME(s.time));
}

#if CAMERA_FALLS
// At the horizon φ and its twist have a pole. For a camera that falls the azimuth is φ~ = φ − ∫ a/Δ dr from r to infinity, which stays along light that falls straight in; with it
// the pole cancels: (p + w')(p − w') = K_C w² Δ w², p = P w²/|E|. Outside, φ is had back in closed form.
float ingoing_twist(Orbit orbit, float w, float w_rate) {
    float a = RAY_SPIN, p = orbit.energy * (1.0 + (a * a - orbit.a_lambda) * w * w);
    vec2 factors = 1.0 - w * hole_w_factors;
    float carter = orbit.k + a * a - 2.0 * orbit.a_lambda;
    float share = w_rate < 0.0 ? carter * w * w / (p - w_rate) : (p + w_rate) / (factors.x * factors.y);
    return a * (orbit.energy - share);
}

// w'² at w.
float radial_square(Orbit orbit, float w) {
    return 1.0 + w * w * (orbit.c.x + w * (2.0 / 3.0 * orbit.c.y + w * 0.5 * orbit.c.z));
}

// The twist that gives φ, but inside, where there is none.
float whole_twist(State s) {
    vec2 factors = 1.0 - s.w * hole_w_factors;
    float lag = RAY_SPIN / (hole_w_factors.x - hole_w_factors.y) * log(factors.y / max(factors.x, 1e-6));
    return s.twist + (s.w > 0.0 && factors.x > 0.0 ? lag : 0.0);
}
#else
float whole_twist(State s) {
    return s.twist;
}
#endif

// The twist drives nothing, so it is integrated after the step: Gauss with two points, at the cubic Hermite values of w there, and both
// quotients over one denominator. One division a step, and of fourth order whatever the integrator.
#if RAYS_LIGHT_TRAVEL
#define RAY_QUADRATURE ray_twist_and_time
#else
#define RAY_QUADRATURE ray_twist
#endif
void ray_twist(Orbit orbit, State a, float h, inout State b) {
#if HOLE_SPINS || CAMERA_FALLS
    float middle = 0.5 * (a.w + b.w) + h * (1.0 / 12.0) * (a.w_rate - b.w_rate);
    float aside = 0.384900179 * (b.w - a.w) - 0.0481125224 * h * (a.w_rate + b.w_rate);  // 2/√27, 1/(4√27)
    vec2 w = vec2(middle - aside, middle + aside);
#if CAMERA_FALLS
    float slope = (b.w - a.w) / h, bend = 0.288675135 * (a.w_rate - b.w_rate);  // 1/√12
    b.twist = a.twist + 0.5 * h * (ingoing_twist(orbit, w.x, slope + bend) + ingoing_twist(orbit, w.y, slope - bend));
    // Deep inside w'² is so much larger than the 1 in it, by which rays part farther out, that its rounding would be all that is left of that.
    if (b.w * hole_w_factors.x > 1.0 && b.w_rate < 0.0) b.w_rate = -sqrt(max(radial_square(orbit, b.w), 0.0));
    return;
#endif
    vec2 rate = w * (2.0 - orbit.a_lambda * w);
    vec2 factors = (1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y);
    b.twist = a.twist + 0.5 * h * orbit.drag * (rate.x * factors.y + rate.y * factors.x) / (factors.x * factors.y);
#endif
}

#if RAYS_LIGHT_TRAVEL
TimeConstants time_constants(Orbit orbit) {
    return TimeConstants(orbit.c.y, orbit.c.z, orbit.a_lambda, orbit.energy);
}

TimeEnd time_end(Orbit orbit, State s) {
    State rate = ray_rhs(orbit, s);
    return TimeEnd(vec2(s.w, s.n.z), vec2(s.w_rate, s.n_rate.z), vec2(rate.w_rate, rate.n_rate.z));
}

void ray_twist_and_time(Orbit orbit, State a, float h, inout State b) {
    ray_twist(orbit, a, h, b);
    b.time = a.time + step_time(time_constants(orbit), time_end(orbit, a), time_end(orbit, b), h);
}

#include "common/mino_delay.glsl"
#endif

State state_kick(State s, float h, State k) {
    return State(s.w, s.w_rate + h * k.w_rate, s.n, s.n_rate + h * k.n_rate, s.twist AND_TIME(s.time));
}

State state_push(State s, float h2, State k) {
    return State(s.w + h2 * k.w_rate, s.w_rate, s.n + h2 * k.n_rate, s.n_rate, s.twist AND_TIME(s.time));
}

State state_drift(State s, float h) {
    return State(s.w + h * s.w_rate, s.w_rate, s.n + h * s.n_rate, s.n_rate, s.twist AND_TIME(s.time));
}

float state_difference(Orbit orbit, State a, State b) {
    return abs(a.w - b.w) / orbit.scale + abs(a.w_rate - b.w_rate) + length(a.n - b.n) + length(a.n_rate - b.n_rate) * orbit.scale;
}

float ray_plain_step(Orbit orbit, State s) {
    return plan_step_angle * orbit.scale;
}

void ray_finish(Orbit orbit, State s, inout Hits hits) {
    vec3 n = s.n - (s.w / s.w_rate) * s.n_rate;  // what the root left over
    hits.direction = normalize(vec3(rotate(n.xy, cos_sin(whole_twist(s))), n.z));
}

// w'² = R(w) = 1 + c₂w² + ⅔c₃w³ + ½c₄w⁴, against the sizes of its terms; n stays on the sphere.
#define RAY_DRIFT ray_drift
float ray_drift(Orbit orbit, State s) {
    float w = s.w;
    vec3 terms = orbit.c * vec3(1.0, 2.0 / 3.0, 0.5) * vec3(w * w, w * w * w, w * w * w * w);
    float radial = abs(s.w_rate * s.w_rate - 1.0 - terms.x - terms.y - terms.z);
    return max(radial / (1.0 + abs(terms.x) + abs(terms.y) + abs(terms.z)), abs(length(s.n) - 1.0));
}

float ray_height(State s) {
    return s.n.z;
}

float ray_height_rate(State s) {
    return s.n_rate.z;
}

float ray_elevation(State s) {
    return s.n.z;
}

// As curve.glsl has it, and its rate.
vec2 path_twist(Orbit orbit, State s) {
#if HOLE_SPINS
    vec2 factors = 1.0 - s.w * hole_w_factors;
    return vec2(whole_twist(s), orbit.drag * s.w * (2.0 - orbit.a_lambda * s.w) / (factors.x * factors.y));
#else
    return vec2(0.0);
#endif
}

Path ray_path(Orbit orbit, State s) {
    return Path(vec4(s.n, 2.0 * s.w), vec4(s.n_rate, 2.0 * s.w_rate), path_twist(orbit, s) AND_TIME(path_time(orbit, s)));
}

Momentum ray_momentum(Orbit orbit, State s) {
    return Momentum(s.w_rate, vec3(rotate(s.n_rate.xy, cos_sin(whole_twist(s))), s.n_rate.z));
}

float ray_affine_rate(Orbit orbit, State s) {
    return 0.5 * (1.0 / (s.w * s.w) + RAY_SPIN * RAY_SPIN * s.n.z * s.n.z);  // Σ
}

vec2 ray_plane_point(State s) {
    return rotate(s.n.xy, cos_sin(whole_twist(s))) * inversesqrt(4.0 * s.w * s.w * dot(s.n.xy, s.n.xy));
}
