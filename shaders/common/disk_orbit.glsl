// Circular equatorial orbits in Kerr, and with DISK_PLUNGING matter that falls in from the innermost stable one (blackhole_gl/physics/plunging.py): their rate and
// their frequency shift g = E_infinity / E_emitter.
//
// r is Boyer–Lindquist in r_s, λ = L_z/E of the photon in M, about the disk's axis (common/disk_light.glsl). Inside, M = 1 and x = √(r/M); `turn` is the sense of the
// emitter (disk_spin_sign), and a_t, λ_t are spin and λ measured along it. Bardeen, Press & Teukolsky 1972: Ω = 1/(x³ + a_t),
// u^t = (x³ + a_t)/(x^1.5 √(x³ − 3x + 2a_t)), g = 1/(u^t (1 − Ωλ_t)).
//
// How g is split, for the switches "redshift" and "Doppler": g = g₀ · δ with
//   g₀ = g(λ = 0) = 1/u^t : what a photon without angular momentum suffers: gravity, and the slowing of the emitter's
//                           clock by its motion (transverse Doppler effect), which only g₀ and not δ holds;
//   δ  = 1/(1 − Ωλ)       : what depends on the photon's direction: above 1 on the approaching side, below on the other.
// In the two older viewers' formulas (docs/sources.md), g₀ is √(1 − 1/r) and 1.

#include "common/disk_light.glsl"

// A tilted disk's matter moves as round a hole whose spin is the part along the disk's axis.
float turned_spin() {
#if DISK_TILTED
    return hole_spin * disk_spin_sign * disk_axis_z.z;
#else
    return hole_spin * disk_spin_sign;
#endif
}

// 1 − a_t, without cancellation when the spin is near 1.
float turned_spin_complement() {
    return turned_spin() > 0.0 ? hole_spin_complement : 1.0 + abs(hole_spin);
}

#if DISK_PLUNGING
bool is_falling(float r) {
    return 2.0 * r < disk_fall.x;
}

// Δu^t and Δu^φ of matter that falls in, the latter along the orbit; r in M.
vec2 falling_rates(float r) {
    float a = turned_spin(), energy = disk_fall.y, momentum = disk_fall.z;
    return vec2((r * r + a * a * (1.0 + 2.0 / r)) * energy - 2.0 * a / r * momentum, (1.0 - 2.0 / r) * momentum + 2.0 * a / r * energy);
}

// (g₀, δ) of matter that falls in: g₀ = 1/u^t, and in δ the light's way outwards counts as its way round does.
vec2 disk_shift_falling(float r, DiskLight light, bool inbound) {
    float rm = 2.0 * r, above = max(disk_fall.x / rm - 1.0, 0.0);
    float fall = sqrt(above * (2.0 / 3.0) / disk_fall.x) * above;  // −u^r
    vec2 rates = falling_rates(rm);
    float seen = rates.x - rates.y * disk_spin_sign * light.lambda + fall * rm * rm * outward_rate(light, r, inbound);
    float delta = (rm - hole_w_factors.x) * (rm - hole_w_factors.y);
    return vec2(delta / rates.x, rates.x / max(seen, 1e-3 * rates.x));
}
#endif

// Ω of the matter, in rad per r_s/c, signed by the sense of the orbit.
float disk_rate(float r) {
    float rm = 2.0 * r;
#if DISK_PLUNGING
    if (is_falling(r)) {
        vec2 rates = falling_rates(rm);
        return disk_spin_sign * 2.0 * rates.y / rates.x;
    }
#endif
    return disk_spin_sign * 2.0 / (rm * sqrt(rm) + turned_spin());
}

// Frame dragging of the ray model `kerr_like`, rad per r_s/c: the rate at which it turns light.
float disk_dragged_rate(float r) {
#if RAYS_MODEL_KERR_LIKE
    return 0.5 * rays_kerr_like_drag * hole_spin / (r * r * r);
#else
    return 0.0;
#endif
}

// By how much it carries matter round faster, along the orbit's own sense.
float disk_flow_offset(float r) {
#if RAYS_MODEL_KERR_LIKE && RAYS_KERR_LIKE_FLOW
    return disk_spin_sign * disk_dragged_rate(r);
#else
    return 0.0;
#endif
}

// How fast patterns of the disk are carried round at r, rad per r_s/c.
float disk_pattern_rate(float r) {
#if RAYS_MODEL_KERR_LIKE && RAYS_KERR_LIKE_PATTERN
    return (disk_rate(r) + disk_dragged_rate(r)) * disk_noise_speed;
#else
    return disk_rate(r) * disk_noise_speed;
#endif
}

// (g₀, δ), exact. x³ − 3x + 2a_t is formed as (x−1)²(x+2) − 2(1−a_t): near the ISCO of a fast hole the plain form loses
// three digits. Where no circular orbit exists g₀ is 0.
vec2 disk_shift_exact(float r, float lambda) {
    float rm = 2.0 * r;
    float x = sqrt(rm);
    float above = (rm - 1.0) / (x + 1.0); // x − 1
    float span = above * above * (x + 2.0) - 2.0 * turned_spin_complement();
    float orbit = x * rm + turned_spin();
    float seen = orbit - disk_spin_sign * lambda;
    return vec2(x * sqrt(x * max(span, 0.0)) / orbit, orbit / max(seen, 1e-3 * orbit));
}

#if DISK_TILTED
// The same of matter that turns with the rigid plane of a tilted disk, where the hole's own metric has it: its g₀ = 1/u^t is √(−g_μν v^μ v^ν), v the rate of
// its place by coordinate time.
vec2 disk_shift_tilted(float r, DiskLight light) {
    float rm = 2.0 * r, a = hole_spin, rate = 0.5 * disk_rate(r);
    vec3 n = disk_place(light.heading), along = disk_place(vec2(-light.heading.y, light.heading.x));
    float turning = rate * rm * (n.x * along.y - n.y * along.x);                    // r sin²θ φ'
    float around = turning * turning / max(dot(n.xy, n.xy), 1e-12);                 // r² sin²θ φ'²
    float sigma = 1.0 + a * a * n.z * n.z / (rm * rm), dragged = 1.0 - a * turning / rm;
    float clock = 1.0 - (1.0 + a * a / (rm * rm)) * around - 2.0 / (rm * sigma) * dragged * dragged - sigma * max(rate * rate * rm * rm - around, 0.0);
    return vec2(sqrt(max(clock, 0.0)), 1.0 / max(1.0 - rate * light.lambda, 1e-3));
}
#endif

// The azimuthal direction cosine, along the orbit, of a photon as a static observer at r sees it (Schwarzschild).
float disk_azimuthal_cosine(float r, float lambda) {
    float lapse = sqrt(max(1.0 - 1.0 / r, 0.0));
    return clamp(disk_spin_sign * 0.5 * lambda * lapse / r, -1.0, 1.0);
}

// The orbital-plane renderer's: δ = 1/(γ(1 − v·n)) with the local speed v = √(M/(r − 2M)), times √(1 − 1/r).
vec2 disk_shift_s0(float r, float lambda) {
    float v = min(sqrt(0.5 / max(r - 1.0, 1e-3)) + r * disk_flow_offset(r) * inversesqrt(max(1.0 - 1.0 / r, 1e-3)), 0.999);
    float delta = sqrt(1.0 - v * v) / (1.0 - v * disk_azimuthal_cosine(r, lambda));
    return vec2(sqrt(max(1.0 - 1.0 / r, 0.0)), delta);
}

// BlackHoleGPU's: v = √((M/r)(1 − 3M/r)), D = γ(1 + β·n); no gravitational part.
vec2 disk_shift_s1(float r, float lambda) {
    float v = min(sqrt(max(0.5 / r * (1.0 - 1.5 / r), 0.0)) + r * disk_flow_offset(r), 0.999);
    return vec2(1.0, (1.0 + v * disk_azimuthal_cosine(r, lambda)) * inversesqrt(1.0 - v * v));
}

// λ, no larger along the orbit than light that passes r in the plane can have: the root of (r² + a² − aλ)² = Δ(λ − a)², M = 1
// (Bardeen, Press & Teukolsky 1972). A pixel so wide that it shows a disk far from its own crossing brings a λ from there.
float possible_lambda(float r, float lambda) {
    float rm = 2.0 * r, a = turned_spin();
    float root = sqrt(max(rm * rm - 2.0 * rm + a * a, 0.0));
    float most = (rm * rm + a * a + a * root) / max(a + root, 1e-6);
    return disk_spin_sign * min(disk_spin_sign * lambda, most);
}

// (g₀, δ), exact but for the dragging of `kerr_like`, which carries the matter round faster by ω: 1/u^t² is less by ω (2 Ω g_φφ + 2 g_tφ + ω g_φφ), and
// δ = 1/(1 − (Ω + ω) λ). Bounded where that would be faster than light.
vec2 disk_shift_dragged(float r, float lambda) {
    vec2 shift = disk_shift_exact(r, lambda);
    float rm = 2.0 * r, a = turned_spin();
    float more = 0.5 * disk_flow_offset(r), rate = 0.5 * abs(disk_rate(r)); // per M
    float area = rm * rm + a * a * (1.0 + 2.0 / rm);                        // g_φφ; g_tφ is −2a/r
    float lost = more * (area * (2.0 * rate + more) - 4.0 * a / rm);
    float clock = max(1.0 - lost / max(shift.x * shift.x, 1e-6), 0.02);
    return vec2(shift.x * sqrt(clock), shift.y / max(1.0 - shift.y * more * disk_spin_sign * lambda, 0.05));
}

// (g₀, δ) by the formula the scene names.
vec2 disk_shift(float r, DiskLight light, bool inbound) {
    float lambda = light.lambda;
#if DISK_PLUNGING
    if (is_falling(r)) return disk_shift_falling(r, light, inbound);
#endif
#if DISK_FREQUENCY_SHIFT_S0
    return disk_shift_s0(r, lambda);
#elif DISK_FREQUENCY_SHIFT_S1
    return disk_shift_s1(r, lambda);
#elif RAYS_MODEL_KERR_LIKE && RAYS_KERR_LIKE_FLOW
    return disk_shift_dragged(r, possible_lambda(r, lambda));
#elif DISK_TILTED
    return disk_shift_tilted(r, light);
#else
    return disk_shift_exact(r, possible_lambda(r, lambda));
#endif
}

// Cosine between a photon and the orbit, as an observer without angular momentum (ZAMO) at r sees them: L_z over √g_φφ and over the photon's energy there
// (Bardeen, Press & Teukolsky 1972). 1 where the matter comes straight at who sees the light.
float disk_approach(float r, float lambda) {
    float rm = 2.0 * r, a = turned_spin(), r2 = rm * rm;
    float along = disk_spin_sign * possible_lambda(r, lambda);
    float span = max(r2 - 2.0 * rm + a * a, 0.0);               // Δ
    float area = r2 * (r2 + a * a) + 2.0 * a * a * rm;          // r² g_φφ
    return clamp(along * r2 * sqrt(span) / max(area - 2.0 * a * rm * along, 1e-6 * area), -1.0, 1.0);
}

// Exact g = E_infinity / E_emitter.
float disk_g(float r, DiskLight light, bool inbound) {
#if DISK_PLUNGING
    vec2 shift = is_falling(r) ? disk_shift_falling(r, light, inbound) : disk_shift_exact(r, light.lambda);
#elif DISK_TILTED
    vec2 shift = disk_shift_tilted(r, light);
#else
    vec2 shift = disk_shift_exact(r, light.lambda);
#endif
    return shift.x * shift.y;
}
