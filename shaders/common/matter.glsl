// Light that is gathered along a ray, and what a thing or a medium is told of how it is seen.

// On its way to the camera: gathered so far, and the share of what lies farther on that still comes through.
struct Light {
    vec3 gathered;
    vec3 passed;
};

#if MEETINGS
struct Sight {
    vec3 place;         // r_s
    vec3 towards;       // unit vector along the ray there, towards the camera
    float energy;       // E_observer/E_infinity, as it counts for colours
    float beaming;      // and as it counts for brightness: the same unless parts of the observer's motion are switched off
    bool enters;        // the ray goes into it, traced backwards
    int part;           // of what tells_apart, that which is met; −1 where that is not known
    Momentum momentum;  // of the ray there
    vec3 right, up;     // change of the place to the next pixel on the right and above
};

// Takes differences between pixels, so all pixels must run it: keep it outside every branch. Where the next pixel meets something else, a pixel's width at
// the camera stands in for them, at right angles to the ray.
Sight sight_of(Meeting met, vec2 energy) {
    float r = max(length(met.place), 1e-6);
    vec3 n = met.place / r;
    vec3 backwards = (0.5 / r) * met.momentum.n_rate - met.momentum.w_rate * n;
    vec3 towards = -backwards / max(length(backwards), 1e-20);
    vec3 right = dFdx(met.place), up = dFdy(met.place);
#if HIT_MAP_REFINED != 3  // where all of a cell meet the same
    float what = float(met.kind + 32 * met.index);
    float away = camera_w > 0.0 ? 2.0 * distance(met.place, camera_n.xyz * (0.5 / camera_w)) : 1.0;
    vec3 aside = normalize(cross(towards, abs(towards.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    if (dFdx(what) != 0.0) right = picture_scale * away * aside;
    if (dFdy(what) != 0.0) up = picture_scale * away * cross(aside, towards);
#endif
    return Sight(met.place, towards, energy.x, energy.y, met.enters, int(length(met.note) + 0.5) - 1, met.momentum, right, up);
}

// E_infinity/E_emitter = 1/(u^t (1 − k_i v^i)) of light that leaves, along the ray, matter of velocity v = dx/dt there (c = 1, x as rays tell it):
// its own u^t is (−g_tt − 2 g_tφ φ' − g_φφ φ'² − g_rr r'² − g_θθ θ'²)^(−½), by Boyer and Lindquist's metric of the rays' hole, flat where there is none. M = 1.
// 0 where no matter can move so.
float emitted_shift(Sight sight, vec3 velocity) {
    float r = 2.0 * length(sight.place);
    vec3 n = sight.place * (2.0 / r);
    float outward = dot(velocity, n);
    float aside = dot(sight.momentum.n_rate, velocity) / r;  // −k_θ θ' − k_φ φ'
#if SPACE_TIME_FLAT
    float clock = 1.0 - dot(velocity, velocity), seen = 1.0 - outward * sight.momentum.w_rate + aside;
#else
    float a2 = hole_w_factors.x * hole_w_factors.y, a = hole_spin < 0.0 ? -sqrt(a2) : sqrt(a2);
    float fall = (1.0 - hole_w_factors.x / r) * (1.0 - hole_w_factors.y / r);  // Δ/r²
    float sigma = 1.0 + a2 * n.z * n.z / (r * r);                              // Σ/r²
    float turning = n.x * velocity.y - n.y * velocity.x;                       // r sin²θ φ'
    float around = turning * turning / max(dot(n.xy, n.xy), 1e-12);            // r² sin²θ φ'²
    float down = dot(velocity, velocity) - outward * outward - around;         // r² θ'²
    float dragged = 1.0 - a * turning / r;
    float clock = 1.0 - (1.0 + a2 / (r * r)) * around - 2.0 / (r * sigma) * dragged * dragged - sigma * (outward * outward / fall + down);
    float seen = 1.0 - outward * sight.momentum.w_rate / fall + aside;
#endif
    return sqrt(max(clock, 0.0)) / max(seen, 1e-3);
}

// What a medium is at a place, in the frame of its matter.
struct Matter {
    vec3 emission;    // radiance that it adds on 1 r_s, of all frequencies or of the one that is seen
    vec3 absorption;  // optical depth of 1 r_s
    float shift;      // E_infinity/E of light there, as emitted_shift tells; 0: there can be no matter
};

// E_infinity/E_emitter of matter that turns about the axis with u_φ = −l u_t and nothing else: l in M, its angular momentum over its energy. Exact down to the
// horizon, as no difference is formed: with Q(x, y) = A − 2 a r (x + y) − x y (Δ/sin²θ − a²) it is √(ΣΔ Q(l, l))/Q(λ, l). M = 1. 0 where no matter can turn so.
float circling_shift(Sight sight, float l) {
    float r = 2.0 * length(sight.place);
    vec3 n = sight.place * (2.0 / r);
    float sine = max(length(n.xy), 1e-4), lambda = n.y * sight.momentum.n_rate.x - n.x * sight.momentum.n_rate.y;
#if SPACE_TIME_FLAT
    float a = 0.0, delta = r * r;
#else
    float a2 = hole_w_factors.x * hole_w_factors.y, a = hole_spin < 0.0 ? -sqrt(a2) : sqrt(a2);
    float delta = (r - hole_w_factors.x) * (r - hole_w_factors.y);
#endif
    float sigma = r * r + a * a * n.z * n.z, wide = r * r + a * a, square = wide * wide - delta * a * a * sine * sine, turn = delta / (sine * sine) - a * a;
    float own = square - 4.0 * a * r * l - l * l * turn;
    float seen = square - 2.0 * a * r * (lambda + l) - lambda * l * turn;
    return sqrt(max(sigma * delta * own, 0.0)) / max(seen, 1e-6);
}
#endif
