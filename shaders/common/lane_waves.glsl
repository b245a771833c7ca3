// Lanes that branch and wind, of the disk (disks/lanes.glsl) and of a slab (media/slab.glsl).
#include "common/noise.glsl"
#include "common/rotation.glsl"

const float LANE_TURN = 6.2831853;

// How one family is seen in one pixel: its wave, −1…1, and the mean of that wave's square.
struct LaneWave {
    float height;
    float power;
};

// `number` lanes round the hole, `turn` in turns, `phase` in radians. Between whole numbers of lanes two waves fade over, so that there is no seam; where
// the number changes with the radius lanes branch. `grain` is how far the phase moves within the pixel, in radians: what moves by half a wave is left out.
LaneWave lane_wave(float turn, float number, float phase, float grain) {
    float whole = floor(number), more = number - whole;
    float kept = exp(-0.2 * grain * grain);
    vec2 phases = LANE_TURN * fract(vec2(whole, whole + 1.0) * turn) + phase;
    vec2 weights = kept * vec2(1.0 - more, more);
    return LaneWave(dot(weights, sin(phases)), 0.5 * dot(weights, weights));
}

// Mean of (base + swing·wave)^power over the wave's phases, to fourth order in swing/base: within 0.5 % here.
float lane_mean(float base, float swing, float mean_square, float power) {
    float ratio = swing / base;
    return pow(base, power) * (1.0 + 0.5 * power * (power - 1.0) * ratio * ratio * mean_square);
}

// Where lanes of one pattern are looked at.
struct LanePlace {
    vec2 heading;    // (cos φ, sin φ)
    vec2 footprint;  // in ln r and in φ, beyond which there is no detail
    float depth;     // 0 on the inner edge, 1 on the outer one
    float turned;    // by which the flow has carried the pattern round, radians
    float number;    // times as many lanes as published
    float waver;     // of the second family
};

// Density of the lanes of the pattern of that seed, mean 1.
float lanes_density(LanePlace place, float seed) {
    float turn = turns(place.heading.x, place.heading.y) - place.turned / LANE_TURN + 0.618034 * seed;
    turn -= floor(turn);
    float winding = 1.5 * abs(place.turned);  // radians of azimuth that an e-fold of radius has been wound
    vec2 numbers = max(place.number * mix(vec2(24.0, 11.0), vec2(12.0, 5.0), clamp(place.depth, 0.0, 1.0)), 1.0);
    vec2 phases = vec2(2.5 * place.depth - 1.6 * place.turned, 2.0 * place.waver + 0.85 * place.turned);
    vec2 grains = numbers * (place.footprint.y + winding * place.footprint.x) + vec2(1.6, 0.85) * winding * place.footprint.x;
    LaneWave first = lane_wave(turn, numbers.x, phases.x, grains.x), second = lane_wave(turn, numbers.y, phases.y, grains.y);

    float power = mix(1.5, 0.8, clamp(place.depth, 0.0, 1.0));
    float mask = pow((0.55 + 0.45 * first.height) * (0.6 + 0.4 * second.height), power);
    float mean = lane_mean(0.55, 0.45, first.power, power) * lane_mean(0.6, 0.4, second.power, power);
    float patches = exp(-0.2 * pow(0.5 * (place.footprint.y + winding * place.footprint.x), 2.0)) * ring_noise(turn, 4.0, 3.0 * place.depth, uint(seed) * 4u + 2u);
    return mix(0.35, 1.25, mask * (0.5 + 0.5 * patches)) / mix(0.35, 1.25, 0.5 * mean);
}
