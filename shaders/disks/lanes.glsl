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
#include "common/disk_orbit.glsl"
#include "common/lane_waves.glsl"

// Density of the lanes of one pattern of that age, mean 1.
float lanes_of_pattern(DiskMatter matter, float depth, float age, float seed) {
    float waver = ring_noise(0.05 * age / (64.0 * SIMPLEX_EDGE), 64.0, 0.1 * matter.radius, uint(seed) * 4u + 1u);
    return lanes_density(LanePlace(matter.heading, matter.footprint, depth, disk_pattern_rate(matter.radius) * age, disk_lanes_number, waver), seed);
}

DiskMatter disk_layer_lanes(DiskMatter matter) {
    float depth = (matter.radius - disk_r_in) / max(disk_r_out - disk_r_in, 1e-4);
    vec2 patterns = vec2(lanes_of_pattern(matter, depth, shear_phase.x, shear_seed.x), lanes_of_pattern(matter, depth, shear_phase.y, shear_seed.y));
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw));  // two patterns mixed: the contrast of one
    matter.density *= max(1.0 + disk_lanes_strength * dot(weights, patterns - 1.0), 0.0);
    return matter;
}
