/*---
label = "Dust"
summary = "Clouds of dust: octaves of noise that turn rigidly, every other one backwards, and so are never drawn out into threads."
source = "a Python viewer after rossning92's Blackhole (docs/sources.md): a product of octaves half noise and half constant, octave i at frequency i² · scale, alternate octaves turning opposite ways, density falling outwards; its own has three dimensions"
slot = "disk_layer"
rank = 50
enabled = false

[parameters.strength]
default = 1.0
range = [0.0, 1.5]
help = "Contrast of each octave."

[parameters.octaves]
default = 5
range = [1, 6]
help = "How many octaves are multiplied."

[parameters.scale]
default = 0.8
range = [0.05, 4.0]
unit = "1/r_s"
help = "Frequency of the coarsest octave."

[parameters.stretch]
default = 1.0
range = [0.25, 16.0]
unit = "×"
help = "How much longer the clouds are along the flow than published, where a radian is as long as two r_s across."

[parameters.rate]
default = 0.06
range = [0.0, 1.0]
unit = "rad/(r_s/c)"
help = "How fast each octave turns about the hole, with the flow or against it."

[parameters.falloff]
default = 0.0
range = [0.0, 4.0]
help = "Power with which the dust thins outwards."
---*/
#include "common/noise.glsl"
#include "common/disk_orbit.glsl"
#include "common/rotation.glsl"

const float DUST_TURN = 6.2831853;
const float DUST_DEVIATION = 1.3;  // from ring_noise to the published noise, which swings more

DiskMatter disk_layer_dust(DiskMatter matter) {
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw));
    vec2 slid = (disk_spin_sign * disk_dust_rate / DUST_TURN) * shear_phase.xy;
    float turn = turns(matter.heading.x, matter.heading.y);
    float around = 2.0 * disk_dust_scale / disk_dust_stretch;  // features a radian: the source takes the azimuth twice
    vec2 grain = matter.footprint * vec2(matter.radius * disk_dust_scale, around);
    float density = 1.0, octave = 1.0;
    do {
        float frequency = octave * octave;
        float edges = max(floor(frequency * around * (DUST_TURN / SIMPLEX_EDGE) + 0.5), 1.0);
        float kept = clamp(1.6 - 2.0 * frequency * max(grain.x, grain.y), 0.0, 1.0);
        vec2 strengths = DUST_DEVIATION * disk_dust_strength * kept * kept * (3.0 - 2.0 * kept) * weights;
        vec2 place = turn - slid;
        float height = matter.radius * disk_dust_scale * frequency;
        uvec2 seeds = uvec2(shear_seed.xy) * 16u + uint(octave) + 6u;
        float noise = strengths.x * ring_noise(place.x, edges, height, seeds.x) + strengths.y * ring_noise(place.y, edges, height, seeds.y);
        density *= max(1.0 + noise, 0.0);
        slid = -slid;
        octave += 1.0;
    } while (octave <= float(disk_dust_octaves));
    float thin = pow(disk_r_in / matter.radius, disk_dust_falloff) * (1.0 + disk_dust_falloff);
    matter.density *= density * mix(1.0, thin, min(disk_dust_strength, 1.0));
    return matter;
}
