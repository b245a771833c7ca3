/*---
label = "Turbulence"
summary = "Octaves of sheared noise: filaments that follow the flow."
source = "BlackHoleGPU (docs/sources.md): product of octaves of simplex noise, octave i at frequency i² · scale, alternate octaves turning opposite ways; its own has three dimensions, a thin disk two"
slot = "disk_layer"
rank = 20
enabled = true

[parameters.octaves]
default = 4
range = [1, 6]
help = "How many octaves are multiplied; octave i has i² times the frequency of the first."

[parameters.contrast]
default = 2.0
range = [0.0, 6.0]
help = "Strength of each octave; 0 leaves the smooth disk."

[parameters.stretch]
default = 9.0
range = [1.0, 30.0]
help = "How much longer than wide the eddies are along the flow before it shears them."

[parameters.eddy_rate]
default = 0.03
range = [0.0, 0.5]
unit = "rad/(r_s/c)"
help = "How fast alternate octaves slide past each other, forwards and backwards."
---*/
#include "common/noise.glsl"
#include "common/disk_orbit.glsl"
#include "common/rotation.glsl"

// The noise lives on the sheet of φ and ln r, a whole number of its lattice's edges round the hole. So it has no seam at φ = ±π, and its eddies keep
// their shape at every radius. The octaves' factors are exponentials of noise: their product is log-normal, as the density
// of a turbulent flow is, never negative, and its mean is kept at 1 whatever the number of octaves and the pixel's size.
const float NOISE_DEVIATION = 0.24; // of ring_noise
const float TURN = 6.2831853;

DiskMatter disk_layer_turbulence(DiskMatter matter) {
    float rate = disk_pattern_rate(matter.radius);
    float slide = disk_spin_sign * disk_noise_speed * disk_turbulence_eddy_rate;
    vec2 ages = shear_phase.xy;
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw)); // two patterns mixed: the contrast of one
    // In turns: the place in each pattern's own, unturned frame, and how far the first octave has slid back from there; every other one slides on.
    vec2 turn = turns(matter.heading.x, matter.heading.y) - (rate / TURN) * ages;
    vec2 slid = (slide / TURN) * ages;
    vec2 winding = 1.5 * abs(rate) * ages; // |dφ/d ln r| that the shear has drawn out

    float across = 8.0 * disk_noise_scale;
    float around = across / disk_turbulence_stretch;
    float contrast = disk_turbulence_contrast * disk_density_gain * (1.0 / 9200.0);
    float height = log(matter.radius) * across;
    float exponent = 0.0, variance = 0.0;
    // Features of frequency 1 in a pixel, of the two patterns.
    vec2 grain = max(vec2(matter.footprint.x * across), (matter.footprint.y + winding * matter.footprint.x) * around);
    vec2 strengths;
    float octave = 1.0;
    do {
        float frequency = octave * octave;
        float edges = max(floor(frequency * around * (TURN / SIMPLEX_EDGE) + 0.5), 1.0);
        vec2 place = turn - slid;
        vec2 kept = clamp(1.6 - 2.0 * frequency * grain, 0.0, 1.0); // detail finer than two pixels would only flicker: 1 below 0.3, 0 from 0.8 on
        strengths = contrast * weights * kept * kept * (3.0 - 2.0 * kept);
        uvec2 seeds = uvec2(shear_seed.xy * 16.0 + octave);
        exponent += strengths.x * ring_noise(place.x, edges, height * frequency, seeds.x) + strengths.y * ring_noise(place.y, edges, height * frequency, seeds.y);
        variance += dot(strengths, strengths);
        slid = -slid;
        octave += 1.0;
    } while (octave <= float(disk_turbulence_octaves) && strengths != vec2(0.0)); // where one octave is too fine, so are all that follow
    matter.density *= exp(exponent - 0.5 * NOISE_DEVIATION * NOISE_DEVIATION * variance);
    return matter;
}
