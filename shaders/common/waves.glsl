// Smooth disorder with a known gradient: a sum of plane waves whose directions have nothing to do with each other, in two sizes.

const int WAVES = 6;
const vec4 WAVE[WAVES] = vec4[WAVES](  // cycles a unit of length, and the phase in turns
    vec4(0.71, 0.32, 0.51, 0.13), vec4(-0.44, 0.83, 0.35, 0.58), vec4(0.29, -0.61, 0.79, 0.91),
    vec4(1.43, -0.97, 0.62, 0.27), vec4(-0.81, 1.12, -1.35, 0.74), vec4(0.55, 1.78, 1.03, 0.42));

// (cos, sin) of an angle in whole turns, as cos_sin_turns, by a term less each: to 7e-6 and 6e-7, as fine as disorder asks for.
vec2 wave_at(float turn) {
    float beyond_half = turn - floor(turn) - 0.5, t = 0.25 - abs(beyond_half), s = t * t;
    float c = 0.9999933 + s * (-19.7357521 + s * (64.6605412 - s * 78.2161319));
    return vec2(t * (-6.28316404 + s * (41.3371424 + s * (-81.3407689 + s * 70.9934332))), beyond_half < 0.0 ? c : -c);
}

// (gradient, value) at x; the value is Σ a cos 2π(k·x + phase) with a = 2/9 for the first three waves and 1/9 for the others: −1…1.
vec4 waves(vec3 x) {
    vec3 slope = vec3(0.0);
    vec2 value = vec2(0.0);  // of those in each size
    for (int i = 0; i < WAVES; ++i) {
        vec2 wave = wave_at(dot(WAVE[i].xyz, x) + WAVE[i].w);
        slope += (-6.28318531 / 9.0 * (i < 3 ? 2.0 : 1.0)) * WAVE[i].xyz * wave.y;
        value += wave.x * (i < 3 ? vec2(1.0, 0.0) : vec2(0.0, 1.0));
    }
    return vec4(slope, (2.0 * value.x + value.y) / 9.0);
}
