/*---
label = "Kerr, motion about the hole in closed form (trial)"
summary = "Exact null geodesics of a spinning hole: only M/r and the frame's dragging are marched, the motion about the hole is elliptic functions of Mino time."
source = "Carter 1968; Mino 2003; Jacobi's theta functions; own form of the azimuth without poles (docs/physics.md)"
slot = "ray_model"
rank = 2
kind = "differential"
marches_in = "mino"
step_control = "mino"
space_time = "kerr"
spins = true
second_order = true
exact = true
twin = "kerr"
---*/
// Units M = 1, Mino time τ. w is marched as in kerr.glsl. n_z obeys n_z'² = η − (K − a²)n_z² − a²n_z⁴ = a²(A² − n_z²)(n_z² + B), so that
//     n_z = A cos ψ,  ψ' = Ω q,  q = √(1 − m sin²ψ),  Ω² = a²(A² + B) = D,  m = a²A²/D,
// and with y = 1 − A² the unit vector about the axis is (√y cos ψ, ± sin ψ)/√(1 − n_z²), turned by the precession
//     β' = ± √y a²/(Ω (q + q*)),  q* = √(1 + a²y/D):
// what is left of λ/(1 − n_z²) when the plain spherical triangle is taken off, and smooth over the poles.
// ψ is the amplitude of a phase v that grows evenly (theta functions of small nome), and 1/(q + q*) three terms of its Fourier series in v.

// Constants of the motion about the hole.
struct Polar {
    bool vortical;     // n_z keeps its sign and what follows is of no use; so for radial rays
    float amplitude;   // A
    float turns;       // v/2π at the start
    float turns_rate;
    float root_kc;     // √k', k' the complementary modulus
    float nome2;       // q² of the theta functions
    vec2 axes;         // √y, ±1: n is (axes · (cos ψ, sin ψ)) about the axis
    vec2 base;         // turned by this and the twist
    vec3 precession;   // mean rate in τ, amplitudes of sin 2v and sin 4v
    vec3 n;            // the start itself, for vortical rays
    vec3 n_rate;
};

struct Orbit {
    vec3 c;           // c₂, c₃, c₄
    float a_lambda;
    float drag;       // −a, or a for negative energy
    float scale;      // 1/√(K + 1), the Mino time of about one radian
    Polar polar;
};

struct State {
    float w;
    float w_rate;
    float turns;       // of v since the start
    float turns_rate;  // constant, as are those below
    float twist;       // dragging and mean precession
    float turns_before;  // v/2π at the start
    float amplitude;   // A, 0 for orbits that do not cross the plane
    vec2 node;         // where n is at ψ = π/2, but for the twist
};

// Angle of (x, y) in 0…2π to 1e-7; 0 for (0, 0).
float polar_angle(vec2 v) {
    vec2 size = abs(v);
    bool steep = size.y > size.x;
    vec2 eighth = steep ? size.yx : size;
    float t = (eighth.y - 0.414213562 * eighth.x) / max(eighth.x + 0.414213562 * eighth.y, 1e-30);
    float t2 = t * t;
    float angle = 0.392699082 + t * (1.0 + t2 * (-0.333329552 + t2 * (0.199779257 + t2 * (-0.138798463 + t2 * 0.0806029805))));
    angle = steep ? 1.57079633 - angle : angle;
    angle = v.x < 0.0 ? PI - angle : angle;
    return v.y < 0.0 ? 2.0 * PI - angle : angle;
}

// (cos, sin) of ψ for the phase whose (cos, sin) is `v`: cn and sn as quotients of theta functions.
vec2 amplitude_of(vec2 v, float root_kc, float nome2) {
    float c2 = 1.0 - 2.0 * v.y * v.y;
    return normalize(vec2(root_kc * v.x * (1.0 + nome2 * (2.0 * c2 - 1.0)), v.y * (1.0 - nome2 * (2.0 * c2 + 1.0))));
}

vec2 phase_of(vec2 psi, float root_kc, float nome2) {
    vec2 first = vec2(psi.x, root_kc * psi.y);
    vec2 v = normalize(first);
    for (int i = 0; i < 2; ++i) {
        float c2 = 1.0 - 2.0 * v.y * v.y;
        v = normalize(vec2(first.x * (1.0 - nome2 * (2.0 * c2 + 1.0)), first.y * (1.0 + nome2 * (2.0 * c2 - 1.0))));
    }
    return v;
}

vec2 times_conjugate(vec2 p, vec2 q) {
    return vec2(p.x * q.x + p.y * q.y, p.y * q.x - p.x * q.y);
}

// (1, i) parts of e^{i angle} z.
vec2 precessed(vec3 precession, vec2 v) {
    float s2 = 2.0 * v.x * v.y;
    return cos_sin(s2 * (precession.y + 2.0 * precession.z * (1.0 - 2.0 * v.y * v.y)));
}

Polar polar_motion(RayStart start, float a2, float k, float eta) {
    float z2 = start.n.z * start.n.z;
    float around = start.n.x * start.n_rate.y - start.n.y * start.n_rate.x;
    float tilt = k - a2;
    float d = sqrt(max(tilt * tilt + 4.0 * a2 * eta, 0.0));
    bool vortical = eta < 0.0 || d < 1e-10;
    if (vortical) d = 1.0;
    float omega = sqrt(d);
    float y = clamp(2.0 * around * around / (k + a2 + d), 0.0, 1.0);
    float a2_big = tilt > 0.0 ? 2.0 * a2 * eta / (d + tilt) : 0.5 * (d - tilt);    // a²A²
    float a2_small = tilt > 0.0 ? 0.5 * (d + tilt) : 2.0 * a2 * eta / (d - tilt);  // a²B
    float kc2 = clamp(a2_small / d, 1e-8, 1.0);

    Polar p;
    p.vortical = vortical;
    p.n = start.n;
    p.n_rate = start.n_rate;
    p.amplitude = vortical || eta == 0.0 ? 0.0 : sqrt(1.0 - y);
    float kc = sqrt(kc2);
    p.root_kc = sqrt(kc);
    float e = 0.5 * (1.0 - p.root_kc) / (1.0 + p.root_kc);
    float e4 = e * e * e * e;
    float nome = e * (1.0 + e4 * (2.0 + 15.0 * e4));
    p.nome2 = nome * nome;
    float theta = 1.0 + 2.0 * nome * (1.0 + nome * p.nome2);
    float rate = omega / (theta * theta);
    p.turns_rate = vortical ? 1.0 : rate / (2.0 * PI);

    float q = sqrt(kc2 + a2 * z2 / d);
    vec2 psi = vec2(start.n.z * omega * q, -start.n_rate.z);
    psi = dot(psi, psi) > 1e-30 ? normalize(psi) : vec2(1.0, 0.0);
    vec2 v = phase_of(psi, p.root_kc, p.nome2);
    p.turns = polar_angle(v) / (2.0 * PI);
    if (start.n.z == 0.0) p.turns = psi.y > 0.0 ? 0.25 : 0.75;
    if (vortical) p.turns = 0.0;

    float q_pole = sqrt(1.0 + a2 * y / d);
    float strength = vortical ? 0.0 : (around < 0.0 ? -1.0 : 1.0) * sqrt(y) * a2 / omega;
    vec3 at = strength / (q_pole + vec3(1.0, p.root_kc, kc));
    p.precession = vec3(0.25 * (at.x + at.z) + 0.5 * at.y, (0.25 / rate) * (at.x - at.z), (0.0625 / rate) * (at.x + at.z - 2.0 * at.y));

    // The frame, from place and rate together: on the axis the place has no azimuth.
    p.axes = vec2(sqrt(y), around < 0.0 ? -1.0 : 1.0);
    float beta = strength / (q + q_pole);
    vec2 u = p.axes * psi;
    vec2 u_rate = q * omega * p.axes * vec2(-psi.y, psi.x);
    vec2 frame = d * times_conjugate(start.n.xy, u) + times_conjugate(start.n_rate.xy - beta * vec2(-start.n.y, start.n.x), u_rate);
    p.base = normalize(times_conjugate(frame, precessed(p.precession, v)));
    return p;
}

Orbit ray_orbit(RayStart start) {
    float a = hole_spin;
    float a2 = a * a;
    float z2 = start.n.z * start.n.z;
    float k = dot(start.n_rate, start.n_rate) - a2 * z2;
    float eta = start.n_rate.z * start.n_rate.z + z2 * (k - a2 + a2 * z2);
    vec3 c = vec3(a2 - k, 3.0 * (k - a * (2.0 * start.lambda - a)), -2.0 * a2 * eta);
    return Orbit(c, a * start.lambda, -a * start.energy, inversesqrt(max(k, 0.0) + 1.0), polar_motion(start, a2, k, eta));
}

State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
    Polar p = orbit.polar;
    return State(start.w, start.w_rate, 0.0, p.turns_rate, 0.0, p.turns, p.amplitude, p.axes.y * vec2(-p.base.y, p.base.x));
}

State ray_rhs(Orbit orbit, State s) {
    return State(s.w_rate, s.w * (orbit.c.x + s.w * (orbit.c.y + s.w * orbit.c.z)), s.turns_rate, 0.0, 0.0, s.turns_before, s.amplitude, s.node);
}

State state_step(State s, float h, State k) {
    return State(s.w + h * k.w, s.w_rate + h * k.w_rate, s.turns + h * k.turns, s.turns_rate, s.twist, s.turns_before, s.amplitude, s.node);
}

// The twist drives nothing: Gauss with two points, at the cubic Hermite values of w there, and both quotients over one denominator.
#define RAY_QUADRATURE ray_twist
void ray_twist(Orbit orbit, State a, float h, inout State b) {
    float middle = 0.5 * (a.w + b.w) + h * (1.0 / 12.0) * (a.w_rate - b.w_rate);
    float aside = 0.384900179 * (b.w - a.w) - 0.0481125224 * h * (a.w_rate + b.w_rate);  // 2/√27, 1/(4√27)
    vec2 w = vec2(middle - aside, middle + aside);
    vec2 rate = w * (2.0 - orbit.a_lambda * w);
    vec2 factors = (1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y);
    b.twist = a.twist + h * (orbit.polar.precession.x + 0.5 * orbit.drag * (rate.x * factors.y + rate.y * factors.x) / (factors.x * factors.y));
}

State state_kick(State s, float h, State k) {
    return State(s.w, s.w_rate + h * k.w_rate, s.turns, s.turns_rate, s.twist, s.turns_before, s.amplitude, s.node);
}

State state_push(State s, float h2, State k) {
    return State(s.w + h2 * k.w_rate, s.w_rate, s.turns, s.turns_rate, s.twist, s.turns_before, s.amplitude, s.node);
}

State state_drift(State s, float h) {
    return State(s.w + h * s.w_rate, s.w_rate, s.turns + h * s.turns_rate, s.turns_rate, s.twist, s.turns_before, s.amplitude, s.node);
}

float state_difference(Orbit orbit, State a, State b) {
    return abs(a.w - b.w) / orbit.scale + abs(a.w_rate - b.w_rate);
}

// A whole number of 2⁻²⁰ turns, so that their sums are exact: else each step is rounded the same way, and many steps add up.
float ray_plain_step(Orbit orbit, State s) {
    float h = plan_step_angle * orbit.scale;
    float turns = floor(h * s.turns_rate * 1048576.0 + 0.5) / 1048576.0;
    return turns > 1e-3 ? turns / s.turns_rate : h;
}

float ray_longest_step(Orbit orbit, State s) {
    return orbit.scale;
}

float ray_radius(State s) {
    return 0.5 / max(s.w, 1e-6);
}

// Inside hole_w_stop an inward ray has no turning point left; infinity is w = 0.
int ray_fate(Orbit orbit, State s) {
    if (s.w <= 0.0) return ESCAPED;
    return s.w > hole_w_stop && s.w_rate > 0.0 ? CAPTURED : UNRESOLVED;
}

float ray_end(Orbit orbit, State a, State b, float h) {
    return hermite_root(a.w, h * a.w_rate, b.w, h * b.w_rate);
}

// n'' = −(K + 2a²n_z²)n + a²n_z ẑ in four steps: vortical rays are short.
vec3 vortical_place(Orbit orbit, float time) {
    vec3 n = orbit.polar.n;
    vec3 rate = orbit.polar.n_rate;
    float a2 = hole_spin * hole_spin;
    float k = a2 - orbit.c.x;
    float h = 0.125 * time;
    for (int i = 0; i < (orbit.polar.vortical ? 8 : 0); ++i) {
        vec3 f1 = -(k + 2.0 * a2 * n.z * n.z) * n + vec3(0.0, 0.0, a2 * n.z);
        vec3 m = n + 0.5 * h * (rate + 0.25 * h * f1);
        vec3 f2 = -(k + 2.0 * a2 * m.z * m.z) * m + vec3(0.0, 0.0, a2 * m.z);
        m = n + h * (rate + 0.5 * h * f2);
        vec3 f3 = -(k + 2.0 * a2 * m.z * m.z) * m + vec3(0.0, 0.0, a2 * m.z);
        n += h * (rate + h / 6.0 * (f1 + 2.0 * f2));
        rate += h / 6.0 * (f1 + 4.0 * f2 + f3);
    }
    return n;
}

void ray_finish(Orbit orbit, State s, inout Hits hits) {
    Polar p = orbit.polar;
    float rest = s.w / s.w_rate;  // what the root left over
    float turns = s.turns - rest * s.turns_rate;
    vec2 v = cos_sin(2.0 * PI * fract(p.turns + turns));
    vec2 psi = amplitude_of(v, p.root_kc, p.nome2);
    vec3 n = vec3(rotate(p.axes * psi, rotate(p.base, precessed(p.precession, v))), p.amplitude * psi.x);
    if (p.vortical) n = vortical_place(orbit, turns);
    hits.direction = normalize(vec3(rotate(n.xy, cos_sin(s.twist)), n.z));
}

// w'² = R(w) = 1 + c₂w² + ⅔c₃w³ + ½c₄w⁴, against the sizes of its terms.
#define RAY_DRIFT ray_drift
float ray_drift(Orbit orbit, State s) {
    float w = s.w;
    vec3 terms = orbit.c * vec3(1.0, 2.0 / 3.0, 0.5) * vec3(w * w, w * w * w, w * w * w * w);
    return abs(s.w_rate * s.w_rate - 1.0 - terms.x - terms.y - terms.z) / (1.0 + abs(terms.x) + abs(terms.y) + abs(terms.z));
}

float turns_at(State s) {
    return fract(s.turns_before + s.turns);
}

// A triangle wave with the zeros of n_z = A cos ψ: straight, so that a step finds its zero at once.
float ray_height(State s) {
    return s.amplitude * (abs(turns_at(s) - 0.5) - 0.25);
}

float ray_height_rate(State s) {
    return s.amplitude * s.turns_rate * sign(turns_at(s) - 0.5);
}

float ray_elevation(State s) {
    return 2.0 * PI * ray_height(s);
}

vec2 ray_plane_point(State s) {
    return rotate(turns_at(s) < 0.5 ? s.node : -s.node, cos_sin(s.twist)) * (0.5 / s.w);
}
