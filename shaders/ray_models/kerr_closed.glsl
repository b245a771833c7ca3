/*---
label = "Kerr, closed form"
summary = "Exact null geodesics of a spinning hole, not marched: elliptic functions of Mino time, and Gauss–Legendre for the dragging between crossings."
source = "Carter 1968; Mino 2003; Weierstrass and Biermann; Carlson 1995; own form of the azimuth without poles (docs/performance.md)"
slot = "ray_model"
rank = 2
kind = "closed"
space_time = "kerr"
spins = true
exact = true
twin = "kerr"
---*/
// Units M = 1, Mino time τ. n_z² obeys n_z'² = a²(A² − n_z²)(n_z² + B), so that
//     n_z = A cos ψ,  ψ' = Ω q,  q = √(1 − m sin²ψ),  Ω² = a²(A² + B) = D,  m = a²A²/D,
// and with y = 1 − A² the unit vector about the axis is (√y cos ψ, ± sin ψ)/√(1 − n_z²), turned by the precession
//     β' = ± √y a²/(Ω (q + q*)),  q* = √(1 + a²y/D):
// what is left of λ/(1 − n_z²) when the plain spherical triangle is taken off, and smooth over the poles.
// ψ is the amplitude of a phase v that grows evenly (theta functions of small nome), and 1/(q + q*) three terms of its Fourier series in v.
// The radial motion is in x = w √(K + 1), s = τ √(K + 1): x'² = 1 + c₂x² + ⅔c₃x³ + ½c₄x⁴, solved by ℘ with that quartic's invariants.

const vec2 NODE = vec2(0.339981044, 0.861136312);    // Gauss–Legendre, four points
const vec2 WEIGHT = vec2(0.652145155, 0.347854845);

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


struct Radial {
    float root;   // √(K + 1)
    float x;      // at the start, as are v = x', half the quartic's slope, its second and third derivatives over 24
    float v;
    vec3 c;       // c₂, c₃, c₄
    float g2;     // invariants
    float g3;
    float force;
    float d2;
    float d3;
    float s[12];  // ℘ = 1/z² + Σ s z^{2n+2}
};

Radial radial_motion(RayStart start, float k, float eta) {
    float a = hole_spin;
    Radial r;
    float i = inversesqrt(max(k, 0.0) + 1.0);
    r.root = 1.0 / i;
    r.c = vec3((a * a - k) * i * i, 3.0 * (k - a * (2.0 * start.lambda - a)) * i * i * i, -2.0 * a * a * eta * i * i * i * i);
    r.x = start.w * r.root;
    r.v = start.w_rate;
    r.g2 = r.c.x * r.c.x / 12.0 + 0.5 * r.c.z;
    r.g3 = r.c.z * r.c.x / 12.0 - r.c.x * r.c.x * r.c.x / 216.0 - r.c.y * r.c.y / 36.0;
    float p = r.g2 / 20.0;
    float q = r.g3 / 28.0;
    r.s[0] = p; r.s[1] = q;
    r.s[2] = p * p / 3.0;
    r.s[3] = p * q * (3.0 / 11.0);
    r.s[4] = (2.0 * p * r.s[2] + q * q) / 13.0;
    r.s[5] = (p * r.s[3] + q * r.s[2]) / 10.0;
    r.s[6] = (2.0 * (p * r.s[4] + q * r.s[3]) + r.s[2] * r.s[2]) * (3.0 / 85.0);
    r.s[7] = (p * r.s[5] + q * r.s[4] + r.s[2] * r.s[3]) * (1.0 / 19.0);
    r.s[8] = (2.0 * (p * r.s[6] + q * r.s[5] + r.s[2] * r.s[4]) + r.s[3] * r.s[3]) * (3.0 / 147.0);
    r.s[9] = (p * r.s[7] + q * r.s[6] + r.s[2] * r.s[5] + r.s[3] * r.s[4]) * (6.0 / 184.0);
    r.s[10] = (2.0 * (p * r.s[8] + q * r.s[7] + r.s[2] * r.s[6] + r.s[3] * r.s[5]) + r.s[4] * r.s[4]) * (3.0 / 225.0);
    r.s[11] = (p * r.s[9] + q * r.s[8] + r.s[2] * r.s[7] + r.s[3] * r.s[6] + r.s[4] * r.s[5]) * (6.0 / 270.0);
    float x = r.x;
    r.force = x * (r.c.x + x * (r.c.y + x * r.c.z));
    r.d2 = (r.c.x + x * (2.0 * r.c.y + 3.0 * r.c.z * x)) / 12.0;
    r.d3 = (r.c.y + 3.0 * r.c.z * x) / 6.0;
    return r;
}

// M/r after τ: ℘ by its series at half the time and one duplication, then Biermann's formula.
float w_at(Radial r, float tau) {
    float z = max(0.5 * tau * r.root, 1e-4);
    float z2 = z * z;
    float i = 1.0 / z;
    float p = r.s[11];
    float d = 24.0 * r.s[11];
    for (int n = 10; n >= 0; --n) {
        p = r.s[n] + z2 * p;
        d = float(2 * n + 2) * r.s[n] + z2 * d;
    }
    p = i * i + z2 * p;
    d = -2.0 * i * i * i + z * d;
    float slope = (6.0 * p * p - 0.5 * r.g2) / d;
    float doubled = 0.25 * slope * slope - 2.0 * p;
    d = slope * (p - doubled) - d;
    float lift = doubled - r.d2;
    float v2 = r.v * r.v;
    return (r.x + (r.force * lift - r.v * d + v2 * r.d3) / (2.0 * lift * lift - 0.25 * v2 * r.c.z)) / r.root;
}

// The largest real e of 4e³ = g₂e + g₃.
float resolvent_root(Radial r) {
    float spread = r.g3 * r.g3 / 64.0 - r.g2 * r.g2 * r.g2 / 1728.0;
    float radius = sqrt(max(r.g2, 1e-20) / 12.0);
    float three = 2.0 * radius * cos(acos(clamp(r.g3 / (8.0 * radius * radius * radius), -1.0, 1.0)) / 3.0);
    float part = sqrt(max(spread, 0.0));
    float cube = r.g3 * 0.125 + (r.g3 < 0.0 ? -part : part);
    float one = sign(cube) * pow(abs(cube), 1.0 / 3.0);
    float e = spread <= 0.0 ? three : one + r.g2 / 12.0 / one;
    // Drivers' acos and pow are coarse.
    return e - clamp((e * (4.0 * e * e - r.g2) - r.g3) / max(12.0 * e * e - r.g2, 1e-3), -1e-3, 1e-3);
}

// τ in 0…2ω at which ℘ = p and ℘' = d. √(p − e) comes from ℘', for p − e has lost its digits near a half-period; the first halving
// takes its sign along, R_F follows by duplication.
float halved_time(Radial r, float p, float d) {
    float e = resolvent_root(r);
    float constant = e * e - 0.25 * r.g2;
    float pair = sqrt(max(p * p + e * p + constant, 1e-20));
    float first = -0.5 * d / pair;
    p += pair + first * sqrt(max(2.0 * p + e + 2.0 * pair, 0.0));
    for (int n = 0; n < 3; ++n) {
        pair = sqrt(max(p * p + e * p + constant, 0.0));
        p += pair + sqrt(max((p - e) * (2.0 * p + e + 2.0 * pair), 0.0));
    }
    float i = 1.0 / p;
    float e2 = -0.25 * r.g2 * i * i;
    return 16.0 * sqrt(i) * (1.0 - 0.1 * e2 + r.g3 * i * i * i / 56.0 + e2 * e2 / 24.0) / r.root;
}

// To infinity, or to the innermost crossing. One inversion for all: which ℘ and ℘' is chosen before.
float time_to_end(Radial r, bool escapes, float w_end) {
    float x = r.x;
    float v = r.v;
    float h = r.c.x + x * (2.0 / 3.0 * r.c.y + 0.5 * x * r.c.z);
    float u = 0.5 / (1.0 + max(v, 0.0));
    vec2 inward = vec2(-h * u + r.c.x / 12.0, v * (2.0 / 3.0 * r.c.y + x * r.c.z) * u - 2.0 * h * r.force * u * u);
    float i = 1.0 / max(x, 1e-6);
    vec2 outward = vec2((1.0 - v) * 0.5 * i * i + r.c.x / 12.0, v * (1.0 - v) * i * i * i + 0.5 * r.force * i * i);
    float y = w_end * r.root;
    float end = sqrt(max(1.0 + y * y * (r.c.x + y * (2.0 / 3.0 * r.c.y + y * 0.5 * r.c.z)), 0.0));
    float mixed = x * x * y * y * 0.5 * r.c.z + r.c.y / 1.5 * 0.5 * x * y * (x + y) + r.c.x / 6.0 * (x * x + 4.0 * x * y + y * y) + 1.0;
    i = 1.0 / (y - x);
    float p = 0.5 * (v * end + mixed) * i * i;
    float pull = y * (r.c.x + y * (r.c.y + y * r.c.z));
    float mixed_rate = x * x * y * r.c.z + r.c.y / 3.0 * x * (x + 2.0 * y) + r.c.x / 3.0 * (2.0 * x + y);
    vec2 inside = vec2(p, (0.5 * (v * pull + end * mixed_rate) - end * (v * end + mixed) * i) * i * i);
    vec2 at = escapes ? (v > 0.0 ? inward : outward) : inside;
    return halved_time(r, at.x, at.y);
}

float drag_at(Radial r, float a_lambda, float tau) {
    float w = w_at(r, tau);
    return w * (2.0 - a_lambda * w) / ((1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y));
}

float dragged(Radial r, float a_lambda, float low, float high) {
    float half_way = 0.5 * (high - low);
    float middle = 0.5 * (high + low);
    float total = WEIGHT.x * (drag_at(r, a_lambda, middle - NODE.x * half_way) + drag_at(r, a_lambda, middle + NODE.x * half_way))
                + WEIGHT.y * (drag_at(r, a_lambda, middle - NODE.y * half_way) + drag_at(r, a_lambda, middle + NODE.y * half_way));
    return -hole_spin * half_way * total;
}

// n'' = −(K + 2a²n_z²)n + a²n_z ẑ in four steps: vortical rays are short.
vec3 vortical_place(Polar p, float k, float time) {
    vec3 n = p.n;
    vec3 rate = p.n_rate;
    float a2 = hole_spin * hole_spin;
    float h = 0.125 * time;
    for (int i = 0; i < (p.vortical ? 8 : 0); ++i) {
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

Hits trace_ray(RayStart start) {
    Hits hits = no_hits(start.lambda);
    hits.steps = 1;
    float a2 = hole_spin * hole_spin;
    float z2 = start.n.z * start.n.z;
    float k = dot(start.n_rate, start.n_rate) - a2 * z2;
    float eta = start.n_rate.z * start.n_rate.z + z2 * (k - a2 + a2 * z2);
    float a_lambda = hole_spin * start.lambda;
    Polar p = polar_motion(start, a2, k, eta);
    Radial r = radial_motion(start, k, eta);

    float slope = 3.0 - a2 - a_lambda;
    float offset = 2.0 * (1.0 - a2);
    float y = sqrt(max(slope, 0.0)) + pow(offset, 1.0 / 3.0);
    for (int n = 0; n < 5; ++n) y = (2.0 * y * y * y + offset) / (3.0 * y * y - slope);
    float barrier = 1.0 / (1.0 + y);
    float yb = barrier * r.root;
    bool turned = 1.0 + yb * yb * (r.c.x + yb * (2.0 / 3.0 * r.c.y + yb * 0.5 * r.c.z)) < 0.0;
    bool escapes = (turned ? start.w < barrier : start.w_rate < 0.0) || a_lambda >= 2.0 * hole_w_factors.x;
    hits.fate = escapes ? ESCAPED : CAPTURED;
    float end = time_to_end(r, escapes, 0.5 / crossing_r_min);

    float half_turn = 0.5 / p.turns_rate;
    float tau = fract(0.25 - p.turns + (p.turns > 0.75 ? 1.0 : 0.0));
    tau = tau >= 0.5 ? tau - 0.5 : tau;
    if (tau == 0.0) tau = 0.5;
    float phase = fract(p.turns + tau);
    tau *= 2.0 * half_turn;
    vec2 node = p.axes.y * vec2(-p.base.y, p.base.x) * (abs(phase - 0.25) < 0.1 ? 1.0 : -1.0);
    float before = 0.0;
    float twist = 0.0;
#if ORDERS > 0
    for (int order = 0; order < ORDERS; ++order) {
        if (tau >= end || p.amplitude == 0.0) break;
        twist += dragged(r, a_lambda, before, tau) + p.precession.x * (tau - before);
        add_crossing(hits, rotate(node, cos_sin(twist)) * (0.5 / w_at(r, tau)));
        node = -node;
        before = tau;
        tau += half_turn;
    }
#endif
    if (escapes) {
        twist += p.precession.x * (end - before);
        int pieces = p.vortical ? 1 : int(clamp(ceil((end - before) / half_turn), 1.0, 12.0));
        float piece = (end - before) / float(pieces);
        do {
            twist += dragged(r, a_lambda, before, before + piece);
            before += piece;
        } while (--pieces > 0);
        vec2 v = cos_sin(2.0 * PI * fract(p.turns + end * p.turns_rate));
        vec2 psi = amplitude_of(v, p.root_kc, p.nome2);
        vec3 n = vec3(rotate(p.axes * psi, rotate(p.base, precessed(p.precession, v))), p.amplitude * psi.x);
        if (p.vortical) n = vortical_place(p, k, end);
        hits.direction = normalize(vec3(rotate(n.xy, cos_sin(twist)), n.z));
    }
    return hits;
}
