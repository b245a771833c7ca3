// How long light has been under way, for models in Mino time with w'' = c₂w + c₃w² + c₄w³, so that w'² = 1 + c₂w² + ⅔c₃w³ + ½c₄w⁴ (M = 1, E = 1):
//     dt/dτ = 1/w² + 2/w + rest,  rest = (4 + a² − aλ − 2a²w + a²(a² − aλ)w²)/((1 − w r₊)(1 − w r₋)) + aλ − a² + a² cos² θ
// after Carter's t' = (r² + a²)(r² + a² − aλ)/Δ + a(λ − a sin² θ). What has no bound far out is a rate of
//     F = −w'/w ∓ 2 ln((1 ± w')/w):   1/w² + 2/w = dF/dτ + c₃w/3 + c₄w²/2 + 2w²(c₃/3 + c₄w/2)/(1 ± w')
// with the sign of w', so that nothing cancels. So a step adds the difference of F and the integral of what is smooth.

#if RAYS_LIGHT_TRAVEL
// F; at infinity, where rays begin, less r + 2 ln(r/2).
float far_time(float w, float w_rate, float sense) {
    return w > 0.0 ? -w_rate / w - 2.0 * sense * log((1.0 + sense * w_rate) / w) : -2.77258872;
}

// One end of a step: w and cos θ with their rates and the rates of these.
struct TimeEnd {
    vec2 value, rate, force;
};

// What a way's time depends on, beside its place.
struct TimeConstants {
    float c3, c4, a_lambda;
    float energy;  // its sign
};

// Rate of what a step adds beside F.
float smooth_time_rate(TimeConstants of, float w, float w_rate, float cosine, float sense) {
    float a2 = hole_w_factors.x * hole_w_factors.y, w2 = w * w;
    float bent = of.c3 * (1.0 / 3.0) + 0.5 * of.c4 * w;
    float fall = (1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y);
    float rest = (4.0 + a2 - of.a_lambda - 2.0 * a2 * w + a2 * (a2 - of.a_lambda) * w2) / fall + of.a_lambda - a2 + a2 * cosine * cosine;
    return bent * w + 2.0 * bent * w2 / (1.0 + sense * w_rate) + rest;
}

// The time, in M, in a step of h between its ends: Gauss with three points, at the values of the quintic Hermite polynomial.
float step_time(TimeConstants of, TimeEnd a, TimeEnd b, float h) {
    if (h == 0.0) return 0.0;
    float sense = a.rate.x + b.rate.x < 0.0 ? -1.0 : 1.0, sum = 0.0;
    for (int i = -1; i < 2; ++i) {
        float t = 0.5 + 0.387298335 * float(i), t2 = t * t, t3 = t2 * t;
        float rise = t3 * (10.0 - t * (15.0 - 6.0 * t)), steep = 30.0 * t2 * (1.0 - t) * (1.0 - t);
        vec2 value = a.value + rise * (b.value - a.value)
                   + h * (t * (1.0 - t2 * (6.0 - t * (8.0 - 3.0 * t))) * a.rate - t3 * (4.0 - t * (7.0 - 3.0 * t)) * b.rate)
                   + 0.5 * h * h * t2 * (1.0 - t) * (1.0 - t) * ((1.0 - t) * a.force + t * b.force);
        float w_rate = steep * (b.value.x - a.value.x) / h
                     + (1.0 - t2 * (18.0 - t * (32.0 - 15.0 * t))) * a.rate.x - t2 * (12.0 - t * (28.0 - 15.0 * t)) * b.rate.x
                     + 0.5 * h * t * (1.0 - t) * ((2.0 - t * (7.0 - 5.0 * t)) * a.force.x + t * (3.0 - 5.0 * t) * b.force.x);
        sum += (i == 0 ? 4.0 / 9.0 : 5.0 / 18.0) * smooth_time_rate(of, value.x, w_rate, value.y, sense);
    }
    return of.energy * (far_time(b.value.x, b.rate.x, sense) - far_time(a.value.x, a.rate.x, sense) + h * sum);
}

// dt/dτ in M at a place not infinitely far.
float time_rate(TimeConstants of, TimeEnd at) {
    float a2 = hole_w_factors.x * hole_w_factors.y, w = at.value.x, w2 = w * w;
    float fall = (1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y), wide = 1.0 + a2 * w2;
    return of.energy * (wide * (wide - of.a_lambda * w2) / (fall * w2) + of.a_lambda - a2 + a2 * at.value.y * at.value.y);
}

// Path.delay of a place so late, with its rate: from infinity all light comes early.
vec2 path_time_at(float w, float w_rate, float delay, float rate) {
    return w > 0.0 ? 2.0 * vec2(w * delay, w * rate + w_rate * delay) : vec2(-1.0, 0.0);
}
#endif
