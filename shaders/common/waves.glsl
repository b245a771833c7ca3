// Smooth disorder with a known gradient: a sum of plane waves whose directions have nothing to do with each other, in two sizes.

const int WAVES = 6;
const vec4 WAVE[WAVES] = vec4[WAVES](  // cycles a unit of length, and the phase in turns
    vec4(0.71, 0.32, 0.51, 0.13), vec4(-0.44, 0.83, 0.35, 0.58), vec4(0.29, -0.61, 0.79, 0.91),
    vec4(1.43, -0.97, 0.62, 0.27), vec4(-0.81, 1.12, -1.35, 0.74), vec4(0.55, 1.78, 1.03, 0.42));

// (gradient, value) at x; the value is Σ a cos 2π(k·x + phase) with a = 2/9 for the first three waves and 1/9 for the others: −1…1.
vec4 waves(vec3 x) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < WAVES; ++i) {
        vec2 wave = cos_sin_turns(dot(WAVE[i].xyz, x) + WAVE[i].w);
        float share = i < 3 ? 2.0 / 9.0 : 1.0 / 9.0;
        sum += vec4((-6.28318531 * share) * WAVE[i].xyz, share) * wave.yyyx;
    }
    return sum;
}
