// dx/dt of matter (c = 1, x as rays tell it) that an observer with no angular momentum, who is carried round with the hole and no more (ZAMO), sees move by `beta`
// there, |beta| < 1: such a speed can be anywhere outside the horizon, within the ergosphere too. Without a hole it is `beta` itself. M = 1.
// With the lapse α = √(ΣΔ/A) and Ω = 2ar/A: r' = α√(Δ/Σ) β_r, r θ' = α r/√Σ β_θ, r sin θ φ' = Ω r sin θ + α r √(Σ/A) β_φ.
vec3 zamo_velocity(vec3 x, vec3 beta) {
#if SPACE_TIME_FLAT
    return beta;
#else
    float r = 2.0 * length(x);
    vec3 n = x * (2.0 / r);
    float a2 = hole_w_factors.x * hole_w_factors.y, a = hole_spin < 0.0 ? -sqrt(a2) : sqrt(a2);
    float delta = (r - hole_w_factors.x) * (r - hole_w_factors.y), sigma = r * r + a2 * n.z * n.z, wide = r * r + a2;
    float square = wide * wide - delta * a2 * dot(n.xy, n.xy);  // A
    float lapse = sqrt(max(sigma * delta, 0.0) / square), stretch = r * inversesqrt(sigma);
    float outward = dot(beta, n);
    vec3 around = vec3(-n.y, n.x, 0.0);
    vec3 along_phi = around * (dot(around, beta) / max(dot(n.xy, n.xy), 1e-12));  // β_φ e_φ
    vec3 aside = beta - outward * n + (sigma * inversesqrt(square) - 1.0) * along_phi;
    return lapse * (sqrt(max(delta, 0.0) / sigma) * outward * n + stretch * aside) + (2.0 * a * r * r / square) * around;
#endif
}
