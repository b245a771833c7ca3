/*---
label = "Turbulence"
summary = "Octaves of sheared noise: filaments that follow the flow."
source = "S1: product of octaves of 3-D simplex noise, octave i at frequency i² · scale, alternate octaves turning opposite ways"
slot = "disk_layer"
rank = 20

[parameters.octaves]
default = 4
range = [1, 6]
help = "How many octaves are multiplied; octave i has i² times the frequency of the first."

[parameters.contrast]
default = 2.0
range = [0.0, 6.0]
help = "Strength of each octave; 0 leaves the smooth disk."

[parameters.stretch]
default = 5.0
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

// The noise lives on a cylinder: (cos φ, sin φ)·around and ln r·across. So it has no seam at φ = ±π, and its eddies
// keep their shape at every radius.
//
// How much one octave of one phase adds to a density of 1: mean 0. `log_step`, `turn_step`: pixel footprint in ln r and φ.
float turbulence_octave(vec2 heading, float log_r, float across, float around, vec2 footprint, uint seed) {
    // Detail finer than two pixels is faded out; it would only flicker.
    float detail = max(footprint.x * across, footprint.y * around);
    float kept = 1.0 - smoothstep(0.35, 0.9, detail);
    if (kept <= 0.0)
        return 0.0;
    return disk_turbulence_contrast * kept * simplex_noise(vec3(heading * around, log_r * across), seed);
}

// All octaves of one phase of the shear, `age` old: deviation of the density from 1.
float turbulence_phase(DiskMatter matter, float age, float seed) {
    float rate = disk_rate(matter.radius) * disk_noise_speed;
    float winding = 1.5 * abs(rate) * age; // |dφ/d ln r| that the shear has drawn out
    float across = 8.0 * disk_noise_scale;
    float around = across / disk_turbulence_stretch;
    float product = 1.0;
    for (int i = 1; i <= int(disk_turbulence_octaves); ++i) {
        float frequency = float(i * i);
        float slide = (i % 2 == 0 ? -1.0 : 1.0) * disk_spin_sign * disk_turbulence_eddy_rate * disk_noise_speed * age;
        float angle = -(rate * age + slide);
        vec2 turn = vec2(cos(angle), sin(angle));
        vec2 heading = vec2(turn.x * matter.heading.x - turn.y * matter.heading.y, turn.y * matter.heading.x + turn.x * matter.heading.y);
        vec2 footprint = vec2(matter.footprint.x, matter.footprint.y + winding * matter.footprint.x);
        product *= max(1.0 + turbulence_octave(heading, log(matter.radius), across * frequency, around * frequency, footprint,
                                               uint(seed) * 16u + uint(i)), 0.0);
    }
    return product - 1.0;
}

DiskMatter disk_layer_turbulence(DiskMatter matter) {
    float first = shear_phase.z > 0.0 ? turbulence_phase(matter, shear_phase.x, shear_seed.x) : 0.0;
    float second = shear_phase.w > 0.0 ? turbulence_phase(matter, shear_phase.y, shear_seed.y) : 0.0;
    // Divided by the weights' norm, so that two independent patterns half mixed have the contrast of one.
    float deviation = (shear_phase.z * first + shear_phase.w * second) * inversesqrt(dot(shear_phase.zw, shear_phase.zw));
    matter.density *= max(1.0 + disk_density_gain / 9200.0 * deviation, 0.0);
    return matter;
}
