/*---
label = "Lanes"
summary = "Two families of bright lanes that drift through the flow in opposite senses and are wound up by its shear."
source = "BlackHoleGPU (docs/sources.md): frequencies, phases, masks and powers of its lane families; its third dimension is left out, as the disk is thin"
slot = "disk_layer"
rank = 30
enabled = false

[parameters.strength]
default = 1.0
range = [0.0, 3.0]
help = "Contrast; 1 as published."

[parameters.number]
default = 1.0
range = [0.25, 4.0]
unit = "×"
help = "Multiplies the lanes round the hole: 12 to 24 of one family, 5 to 11 of the other, most at the inner edge."
---*/
#include "common/noise.glsl"
#include "common/disk_orbit.glsl"
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

// Density of the lanes of one pattern of that age, mean 1. `depth` is 0 on the inner edge and 1 on the outer one.
float lanes_of_pattern(DiskMatter matter, float depth, float age, float seed) {
    float turned = disk_pattern_rate(matter.radius) * age;
    float turn = turns(matter.heading.x, matter.heading.y) - turned / LANE_TURN + 0.618034 * seed;
    turn -= floor(turn);
    float winding = 1.5 * abs(turned);  // radians of azimuth that an e-fold of radius has been wound
    vec2 numbers = max(disk_lanes_number * mix(vec2(24.0, 11.0), vec2(12.0, 5.0), clamp(depth, 0.0, 1.0)), 1.0);
    float waver = ring_noise(0.05 * age / (64.0 * SIMPLEX_EDGE), 64.0, 0.1 * matter.radius, uint(seed) * 4u + 1u);
    vec2 phases = vec2(2.5 * depth - 1.6 * turned, 2.0 * waver + 0.85 * turned);
    vec2 grains = numbers * (matter.footprint.y + winding * matter.footprint.x) + vec2(1.6, 0.85) * winding * matter.footprint.x;
    LaneWave first = lane_wave(turn, numbers.x, phases.x, grains.x), second = lane_wave(turn, numbers.y, phases.y, grains.y);

    float power = mix(1.5, 0.8, clamp(depth, 0.0, 1.0));
    float mask = pow((0.55 + 0.45 * first.height) * (0.6 + 0.4 * second.height), power);
    float mean = lane_mean(0.55, 0.45, first.power, power) * lane_mean(0.6, 0.4, second.power, power);
    float patches = exp(-0.2 * pow(0.5 * (matter.footprint.y + winding * matter.footprint.x), 2.0)) * ring_noise(turn, 4.0, 3.0 * depth, uint(seed) * 4u + 2u);
    return mix(0.35, 1.25, mask * (0.5 + 0.5 * patches)) / mix(0.35, 1.25, 0.5 * mean);
}

DiskMatter disk_layer_lanes(DiskMatter matter) {
    float depth = (matter.radius - disk_r_in) / max(disk_r_out - disk_r_in, 1e-4);
    vec2 patterns = vec2(lanes_of_pattern(matter, depth, shear_phase.x, shear_seed.x), lanes_of_pattern(matter, depth, shear_phase.y, shear_seed.y));
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw));  // two patterns mixed: the contrast of one
    matter.density *= max(1.0 + disk_lanes_strength * dot(weights, patterns - 1.0), 0.0);
    return matter;
}
