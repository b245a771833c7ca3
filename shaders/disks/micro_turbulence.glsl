/*---
label = "Micro-turbulence"
summary = "A fine grain over everything."
source = "BlackHoleGPU (docs/sources.md): density times 0.85 to 1.15 by noise at 18 times the base scale"
slot = "disk_layer"
rank = 40
enabled = false

[parameters.strength]
default = 1.0
range = [0.0, 6.0]
unit = "×"
help = "Contrast of the grain; 1 as published, 0.85 to 1.15."
---*/
#include "common/noise.glsl"
#include "common/disk_orbit.glsl"
#include "common/rotation.glsl"

const float GRAIN_FREQUENCY = 18.0;  // over disk.noise_scale, per r_s
const float GRAIN_STRETCH = 6.0;  // longer than wide along the flow; as that shears it, finer grain would be gone at once

DiskMatter disk_layer_micro_turbulence(DiskMatter matter) {
    float across = GRAIN_FREQUENCY * disk_noise_scale * matter.radius;  // grains an e-fold of radius
    float around = GRAIN_FREQUENCY * disk_noise_scale * 0.5 * (disk_r_in + disk_r_out) / GRAIN_STRETCH;
    float rate = disk_pattern_rate(matter.radius);
    vec2 ages = shear_phase.xy;
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw));
    vec2 winding = 1.5 * abs(rate) * ages;
    vec2 fine = max(vec2(matter.footprint.x * across), (matter.footprint.y + winding * matter.footprint.x) * around);
    vec2 kept = clamp(1.6 - 2.0 * fine, 0.0, 1.0);
    vec2 strengths = 0.15 * disk_micro_turbulence_strength * weights * kept * kept * (3.0 - 2.0 * kept);
    vec2 turn = turns(matter.heading.x, matter.heading.y) - (rate / 6.2831853) * ages;
    float edges = max(floor(around * (6.2831853 / SIMPLEX_EDGE) + 0.5), 1.0);
    uvec2 seeds = uvec2(shear_seed.xy) * 16u + 13u;
    float grain = strengths.x * ring_noise(turn.x, edges, across, seeds.x) + strengths.y * ring_noise(turn.y, edges, across, seeds.y);
    matter.density *= max(1.0 + grain, 0.0);
    return matter;
}
