// When the light that is seen left what it shows. With rays.light_travel the clock of the disk's and the media's patterns is set back for each crossing or place by
// `look_back`; what is included behind this file then reads the patterns of that time under the names of those of scene time.

#include "common/earlier.glsl"

#if RAYS_LIGHT_TRAVEL
vec4 seen_phase, seen_seed;

// (age, seed) of a pattern so much earlier: in an earlier life, perhaps, which has a seed of its own (blackhole_gl/physics/shear.py).
vec2 earlier_life(float age, float seed, float delay) {
    float lives = (age - delay) / float(SHEAR_PERIOD), back = floor(lives);
    return vec2((lives - back) * float(SHEAR_PERIOD), mod(seed + back * float(SHEAR_SEEDS_A_LIFE), float(SHEAR_SEEDS)));
}

void look_back(float delay) {
    vec2 first = earlier_life(shear_phase.x, shear_seed.x, delay), second = earlier_life(shear_phase.y, shear_seed.y, delay);
    float weight = 0.5 - 0.5 * cos_sin_turns(first.x / float(SHEAR_PERIOD)).x;
    seen_delay = delay;
    seen_phase = vec4(first.x, second.x, weight, 1.0 - weight);
    seen_seed = vec4(first.y, second.y, 0.0, 0.0);
}

#undef shear_phase
#undef shear_seed
#define shear_phase seen_phase
#define shear_seed seen_seed
#endif
