/*---
label = "Kerr, Kerr–Schild"
summary = "Exact null geodesics of a spinning hole by Hamilton's equations in Cartesian Kerr–Schild coordinates: the second, independent form of Kerr."
source = "Kerr & Schild 1965; docs/physics.md"
slot = "ray_model"
rank = 6
kind = "differential"
marches_in = "mino"
step_control = "mino"
space_time = "kerr"
spins = true
second_order = false  # not separated: the momenta's rates depend on the momenta
exact = true
tilted_disk = true
---*/
// H = ½(p² − 1 − f κ²), κ = E + l·p, with the f and l of ingoing coordinates (units M = 1). A ray traced backwards is a photon of the
// time-reversed space-time, Kerr with −a, that moves along the look direction.
// The unknowns are not (x, p) but n = x/R, w = 1/R, L = x × p and p_n = n·p, and the parameter runs as dλ/R²: every factor R cancels,
// infinity is w = 0 and is reached, and b keeps all its digits however far the camera is. With ρ = w r, q = a w: r² + a² = (ρ² + q²)/w².
//
// Ingoing coordinates serve light that goes in: near the horizon light that comes out has |p| ~ 1/Δ in them. A ray carries the sign of its
// chart (+1 ingoing, −1 outgoing, which is its time reversal) and changes over where it turns.

#define RAY_RECHARTS

#define RAY_FIRST_ORDER

struct Orbit {
    float scale;  // 1/√(L² + 1) at the camera
};

struct State {
    vec3 n;
    float w;
    vec3 l;
    float p_n;
    float chart;
    float energy;  // constant, ±1
};

// r w: from r⁴ − (R² − a²) r² − a² z² = 0.
float kerr_rho(float q2, float nz2) {
    float gap = 1.0 - q2;
    return sqrt(0.5 * (gap + sqrt(gap * gap + 4.0 * q2 * nz2)));
}

float kerr_w(State s) {
    float q = hole_spin * s.w;
    return s.w / kerr_rho(q * q, s.n.z * s.n.z);
}

// ∫ dr/Δ from r = 1/w to infinity = artanh(σ w/(1 − w))/σ with σ = √(1 − a²); halved thrice, then the series, good to 1e-8.
float azimuth_lag(float w) {
    float sigma = 0.5 * (hole_w_factors.x - hole_w_factors.y);
    float x = sigma * w / (1.0 - w);
    for (int i = 0; i < 3; ++i) x = x / (1.0 + sqrt((1.0 - x) * (1.0 + x)));
    float x2 = x * x;
    return 8.0 * x * (1.0 + x2 * (1.0 / 3.0 + x2 * (1.0 / 5.0 + x2 * (1.0 / 7.0 + x2 * (1.0 / 9.0 + x2 / 11.0))))) / sigma;
}

// arctan(y), |y| ≤ 1: halved twice, then the series, good to 1e-8.
float small_arctan(float y) {
    for (int i = 0; i < 2; ++i) y = y / (1.0 + sqrt(1.0 + y * y));
    float y2 = y * y;
    return 4.0 * y * (1.0 + y2 * (-1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (-1.0 / 7.0 + y2 / 9.0))));
}

Orbit ray_orbit(RayStart start) {
    return Orbit(inversesqrt(dot(start.n_rate, start.n_rate) + 1.0));
}

State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
    float chart = start.w_rate >= 0.0 ? 1.0 : -1.0;
    float a = -chart * hole_spin, w = start.w, aw = a * w;
    float cosine = start.n.z, sine = start.sine;
    float l_over_sine = dot(start.n_rate, start.e_phi), p_theta = dot(start.n_rate, start.e_theta);
    // p_r of the chart, ∓(P − √R)/Δ ± 1, with the difference formed as K/(P + √R).
    float k = dot(start.n_rate, start.n_rate) + hole_spin * (hole_spin * sine * sine - 2.0 * start.lambda);
    float carter_p = start.energy * (1.0 + w * w * hole_spin * (hole_spin - start.lambda));
    float p_r = chart * (k * w * w / (carter_p + abs(start.w_rate)) - start.energy);
    float across = p_theta - aw * l_over_sine * cosine;
    float sigma = 1.0 + aw * aw * cosine * cosine;
    float p_u = (sine * p_r + w * cosine * across) / sigma;
    float p_z = (cosine * (1.0 + aw * aw) * p_r - w * sine * across) / sigma;
    float p_e = w * (l_over_sine + a * p_u);
    float stretch = sqrt(1.0 + aw * aw * sine * sine);

    vec2 lag = cos_sin(hole_spin * chart * azimuth_lag(w));
    vec2 e = rotate(start.e_phi.xy, lag), u = vec2(e.y, -e.x);
    State s;
    s.n = vec3(sine * (u + aw * e), cosine) / stretch;
    s.w = w / stretch;
    s.l.xy = (a * (sine * p_z - cosine * p_u) - cosine * l_over_sine) * u + ((across - aw * a * sine * cosine * p_r) / sigma) * e;
    s.l.z = sine * l_over_sine;
    s.p_n = (sine * (p_u + aw * p_e) + cosine * p_z) / stretch;
    s.chart = chart;
    s.energy = start.energy;
    return s;
}

State ray_rates(State s) {
    float a = -s.chart * hole_spin;
    vec3 l = s.chart * s.l;
    float p_n = s.chart * s.p_n;
    float q = a * s.w, q2 = q * q, nz2 = s.n.z * s.n.z;
    float root = sqrt((1.0 - q2) * (1.0 - q2) + 4.0 * q2 * nz2);
    float rho2 = 0.5 * (1.0 - q2 + root), rho = sqrt(rho2);
    float inv_d = 1.0 / (rho2 * root);  // 1/(ρ⁴ + q² n_z²)
    float c = 1.0 / (rho2 + q2);
    float lean = q2 * s.n.z / rho;
    vec3 across = cross(l, s.n);
    float p_z = p_n * s.n.z + s.w * across.z;
    float along = rho * p_n - q * s.w * l.z;
    float kappa = s.energy + c * (along + lean * p_z);
    float fk = (2.0 * rho / root) * kappa;
    float half_kappa2 = 0.5 * kappa * kappa;

    // f_r, f_z: ∇f = w² (f_r ∇r + f_z ẑ); l_r: the part of ∇(l·p) along ∇r; grad: n·∇r.
    float f_r = 2.0 * rho2 * (3.0 * q2 * nz2 - rho2 * rho2) * inv_d * inv_d;
    float f_z = -4.0 * rho * rho2 * inv_d * inv_d;  // less a factor q² n_z
    float l_r = c * (p_n - 2.0 * rho * c * along - (3.0 + q2 / rho2) * c * q2 * s.n.z * p_z);
    float grad = rho * (rho2 + q2 * nz2) * inv_d;

    vec3 aside = vec3(s.n.y, -s.n.x, 0.0);                       // n × ẑ
    vec3 to_axis = vec3(-s.n.z * s.n.xy, dot(s.n.xy, s.n.xy));   // ẑ across n; not 1 − n_z²: errors of |n| = 1 would grow
    State rate;
    rate.n = s.chart * (across - fk * c * (q * aside + lean * to_axis));
    rate.w = s.chart * (s.w * fk * c * (rho + lean * s.n.z) - p_n);
    float torque = a * q * (s.n.z * (fk * l_r * rho * inv_d + half_kappa2 * (f_r * rho * inv_d + f_z)) + 2.0 * fk * c * p_z / rho);
    rate.l = torque * aside + fk * c * q * vec3(-l.y - (q / rho) * l.x, l.x - (q / rho) * l.y, 0.0);
    rate.p_n = s.w * s.chart * dot(across, rate.n) + half_kappa2 * (f_r * grad + f_z * q2 * nz2) + fk * (l_r * grad + c * (along + lean * p_z));
    rate.chart = rate.energy = 0.0;
    return rate;
}

State ray_rhs(Orbit orbit, State s) {
    return ray_rates(s);
}

State state_step(State s, float h, State k) {
    return State(s.n + h * k.n, s.w + h * k.w, s.l + h * k.l, s.p_n + h * k.p_n, s.chart, s.energy);
}

// The charts differ by a turn about the axis and a shift of time, both functions of r: p changes by the turn and by a multiple of ∇r.
State ray_recharted(State before, State s) {
    float w = kerr_w(s);
    if (s.chart * (kerr_w(before) - w) <= 0.0 || s.w <= 0.0 || w * hole_w_factors.x >= 1.0) return s;
    float a = -s.chart * hole_spin, q2 = a * a * s.w * s.w;
    float rho = s.w / w, inv_d = 1.0 / (rho * rho * rho * rho + q2 * s.n.z * s.n.z);
    float delta = (1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y);
    float kick = w * (4.0 * s.chart * s.energy - 2.0 * a * s.l.z * w) / delta + 2.0 * a * s.l.z * w * w / (1.0 + a * a * w * w);
    s.p_n -= kick * rho * (rho * rho + q2 * s.n.z * s.n.z) * inv_d;
    s.l.xy += (kick * a * a * s.w * s.n.z * rho * inv_d) * vec2(-s.n.y, s.n.x);
    vec2 turn = cos_sin(-2.0 * (hole_spin * s.chart * azimuth_lag(w) + small_arctan(a * w)));
    s.n.xy = rotate(s.n.xy, turn);
    s.l.xy = rotate(s.l.xy, turn);
    s.chart = -s.chart;
    return s;
}

float state_difference(Orbit orbit, State a, State b) {
    return length(a.n - b.n) + abs(a.w - b.w) / orbit.scale + length(a.l - b.l) * orbit.scale + abs(a.p_n - b.p_n);
}

// Shorter where the momentum along the radius exceeds b: light that just misses the horizon, or was sent from beside it.
// Not without end: an integrator of low order lets it run away.
float ray_plain_step(Orbit orbit, State s) {
    return plan_step_angle * clamp(0.5 / max(abs(s.p_n), 1e-6), 0.02 * orbit.scale, orbit.scale);
}

float ray_longest_step(Orbit orbit, State s) {
    return orbit.scale;
}

float ray_radius(State s) {
    return 0.5 / max(kerr_w(s), 1e-6);
}

// The horizon is no special place here; behind it nothing comes back.
int ray_fate(Orbit orbit, State s) {
    if (s.w <= 0.0) return ESCAPED;
    return s.chart > 0.0 && kerr_w(s) * hole_w_factors.x > 1.0 ? CAPTURED : UNRESOLVED;
}

float ray_end(Orbit orbit, State a, State b, float h) {
    return hermite_root(a.w, h * ray_rates(a).w, b.w, h * ray_rates(b).w);
}

void ray_finish(Orbit orbit, State s, inout Hits hits) {
    State rate = ray_rates(s);
    hits.direction = normalize(s.n - (s.w / rate.w) * rate.n);  // less what the root left over; at infinity the azimuths agree
}

// p² − 1 − f κ² = 0, against the sizes of its terms; n stays on the sphere.
#define RAY_DRIFT ray_drift
float ray_drift(Orbit orbit, State s) {
    float q = -s.chart * hole_spin * s.w, q2 = q * q, nz2 = s.n.z * s.n.z;
    vec3 l = s.chart * s.l;
    float p_n = s.chart * s.p_n;
    float rho = kerr_rho(q2, nz2);
    float p_z = p_n * s.n.z + s.w * cross(l, s.n).z;
    float kappa = s.energy + (rho * p_n - q * s.w * l.z + q2 * s.n.z / rho * p_z) / (rho * rho + q2);
    float pull = 2.0 * s.w * rho * rho * rho / (rho * rho * rho * rho + q2 * nz2) * kappa * kappa;
    float p2 = p_n * p_n + s.w * s.w * dot(l, l);
    return max(abs(p2 - 1.0 - pull) / (1.0 + p2 + abs(pull)), abs(length(s.n) - 1.0));
}

float ray_height(State s) {
    return s.n.z;
}

float ray_height_rate(State s) {
    return ray_rates(s).n.z;
}

float ray_elevation(State s) {
    return s.n.z;
}

// (cos φ, sin φ) of Boyer–Lindquist's azimuth at w.
vec2 ray_heading(State s, float w) {
    float turn = s.chart * (small_arctan(hole_spin * w) - hole_spin * azimuth_lag(w));
    return rotate(normalize(s.n.xy), cos_sin(turn));
}

// (sin θ, cos θ) of Boyer–Lindquist's polar angle: cos θ = z/r, |(x, y)|² = (r² + a²) sin² θ.
vec2 ray_polar(State s) {
    float q2 = hole_spin * hole_spin * s.w * s.w;
    float rho = kerr_rho(q2, s.n.z * s.n.z);
    return vec2(length(s.n.xy) * inversesqrt(rho * rho + q2), s.n.z / rho);
}

// dτ/dσ: Mino time by the parameter of the march.
float ray_mino_rate(State s) {
    float q2 = hole_spin * hole_spin * s.w * s.w, nz2 = s.n.z * s.n.z;
    float rho = kerr_rho(q2, nz2);
    return 1.0 / (rho * rho + q2 * nz2 / (rho * rho));
}

// p_θ = cot θ (x p_x + y p_y) − r sin θ p_z with p = p_n n + w L × n; dw/dτ from dw/dσ along the march.
Momentum ray_momentum(Orbit orbit, State s) {
    float q2 = hole_spin * hole_spin * s.w * s.w, nz2 = s.n.z * s.n.z;
    float rho = kerr_rho(q2, nz2), w = s.w / rho;
    vec2 polar = ray_polar(s), heading = ray_heading(s, w);
    float sine = max(polar.x, 1e-6);
    float p_theta = s.n.z * sine * hole_spin * hole_spin * s.w * s.p_n / rho - cross(s.l, s.n).z * rho / sine;
    vec3 e_theta = vec3(polar.y * heading, -polar.x), e_phi = vec3(-heading.y, heading.x, 0.0);

    State rate = ray_rates(s);
    float q2_rate = 2.0 * q2 * rate.w / max(s.w, 1e-20), gap = 1.0 - q2;
    float root = sqrt(gap * gap + 4.0 * q2 * nz2);
    float rho2_rate = 0.5 * (-q2_rate + (2.0 * (q2_rate * nz2 + 2.0 * q2 * s.n.z * rate.n.z) - gap * q2_rate) / root);
    float w_rate = (rate.w - 0.5 * w * rho2_rate / rho) / (rho * ray_mino_rate(s));
    return Momentum(w_rate, p_theta * e_theta + (s.l.z / sine) * e_phi);
}

// In Mino time the place goes by the momentum and by the turn a w (2E + a w L_z)/Δw² about the axis, L_z that of the backward ray.
Path ray_path(Orbit orbit, State s) {
    float w = kerr_w(s), a = hole_spin;
    vec2 polar = ray_polar(s);
    vec3 n = vec3(polar.x * ray_heading(s, w), polar.y);
    Momentum momentum = ray_momentum(orbit, s);
    float turn = -a * w * (2.0 * s.energy + a * s.l.z * w) / ((1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y));
    vec3 n_rate = momentum.n_rate + turn * vec3(-n.y, n.x, 0.0);
    return Path(vec4(n, 2.0 * w), ray_mino_rate(s) * vec4(n_rate, 2.0 * momentum.w_rate), vec2(0.0));
}

float ray_affine_rate(Orbit orbit, State s) {
    return 0.5 / (s.w * s.w);
}

vec2 ray_plane_point(State s) {
    float w = kerr_w(s);
    return ray_heading(s, w) * (0.5 / w);
}
