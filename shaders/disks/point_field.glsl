/*---
label = "Point field"
summary = "A dense rotating field of bright points, with a few boosted rings."
source = "an orbital-plane renderer (docs/sources.md): points with radial tapers, mass biased to small radii, turbulence, narrow ring boosts of high gain"
slot = "disk_layer"
rank = 10
enabled = false

[parameters.share]
default = 0.75
range = [0.0, 1.0]
help = "Share of the disk's matter that is in points; the rest is smooth."

[parameters.rings]
default = 26.0
range = [4.0, 120.0]
help = "Rings of points from one radius to e = 2.7 times it, in the coarsest of three sizes."

[parameters.inward_bias]
default = 1.0
range = [0.0, 4.0]
help = "Power with which the points' mass grows towards small radii."

[parameters.ring_gain]
default = 2.5
range = [0.0, 20.0]
help = "How much brighter the few boosted rings are."

[parameters.turbulence]
default = 0.6
range = [0.0, 2.0]
help = "How much the points gather in clumps along the flow."

[parameters.radial_turbulence]
default = 0.0
range = [0.0, 20.0]
unit = "rings"
help = "How far the rings swerve in and out of their radii, in rings of the coarsest size."

[parameters.taper_inside]
default = 0.06
range = [0.001, 1.0]
help = "Part of the disk's width in which the points fade out towards its inner edge."

[parameters.taper_outside]
default = 0.25
range = [0.001, 1.0]
help = "The same towards its outer edge."
---*/
#include "common/noise.glsl"
#include "common/rotation.glsl"
#include "common/disk_orbit.glsl"

const float POINT_RADIUS = 0.24; // of a cell; with a jitter of ±0.25 no point leaves its own cell, so one cell is enough
const float RINGS_CHOSEN = 0.07; // share of the rings that are boosted

// How much brighter than the mean the rings are that lie in a pixel as wide as `wide` rings, about `place`.
float ring_boost(float place, float wide) {
    float width = clamp(wide, 1e-3, 4.0), low = place - 0.5 * width, high = place + 0.5 * width;
    float chosen = 0.0;
    for (int k = -2; k <= 2; ++k) {
        float ring = floor(place) + float(k);
        chosen += step(1.0 - RINGS_CHOSEN, hash_vec3(hash_lattice(ivec3(int(ring), 7, 7), 99u)).x) * max(min(high, ring + 1.0) - max(low, ring), 0.0);
    }
    chosen = mix(chosen / width, RINGS_CHOSEN, smoothstep(3.0, 8.0, wide));
    return (1.0 + disk_point_field_ring_gain * chosen) / (1.0 + RINGS_CHOSEN * disk_point_field_ring_gain);
}

// Density of the points of one size in one phase of the shear, mean 1. Rings turn rigidly, each at its own rate, and swerve by `swerve` in ln r.
float points_of_size(DiskMatter matter, float rings, float swerve, float age, uint seed) {
    float place = (log(matter.radius) + swerve) * rings;
    float ring = floor(place);
    float cells = floor(6.2831853 * rings);
    float angle = -disk_pattern_rate(exp((ring + 0.5) / rings)) * age;
    vec2 turn = vec2(cos(angle), sin(angle));
    vec2 heading = vec2(turn.x * matter.heading.x - turn.y * matter.heading.y, turn.y * matter.heading.x + turn.x * matter.heading.y);
    float around = (atan(heading.y, heading.x) / 6.2831853 + 0.5) * cells;
    float cell = min(floor(around), cells - 1.0);
    uint h = hash_lattice(ivec3(int(ring), int(cell), 0), seed);
    vec3 draw = hash_vec3(h);
    vec2 jitter = 0.5 * (draw.xy - 0.5), offset = vec2(place - ring, around - cell) - 0.5 - jitter;

    // A point never gets smaller than the pixel, but for its cell, which would cut it off and be drawn so, and keeps its mass; where pixels outgrow cells only
    // the mean is left.
    vec2 pixel = matter.footprint * vec2(rings, cells / 6.2831853);
    vec2 size = min(sqrt(POINT_RADIUS * POINT_RADIUS + pixel * pixel), 0.5 - abs(jitter));
    float fall = max(1.0 - dot(offset / size, offset / size), 0.0);
    float height = 3.0 / (3.1415927 * size.x * size.y);
    float mass = 3.0 * draw.z * draw.z;
    float kept = 1.0 - smoothstep(0.3, 0.8, max(pixel.x, pixel.y));
    return ring_boost(place, pixel.x) * mix(1.0, height * mass * fall * fall, kept);
}

float points_of_phase(DiskMatter matter, float age, float seed) {
    float turn = turns(matter.heading.x, matter.heading.y);
    float swerve = disk_point_field_radial_turbulence / disk_point_field_rings * ring_noise(turn, 7.0, 2.0 * log(matter.radius), uint(seed) * 4u + 3u);
    float sum = points_of_size(matter, disk_point_field_rings, swerve, age, uint(seed) * 4u)
              + points_of_size(matter, disk_point_field_rings * 1.6, swerve, age, uint(seed) * 4u + 1u)
              + points_of_size(matter, disk_point_field_rings * 2.7, swerve, age, uint(seed) * 4u + 2u);
    float clump = ring_noise(turn, 23.0, 6.0 * log(matter.radius), uint(seed));
    return sum / 3.0 * max(1.0 + 2.0 * disk_point_field_turbulence * clump, 0.0);
}

DiskMatter disk_layer_point_field(DiskMatter matter) {
    float points = shear_phase.z * points_of_phase(matter, shear_phase.x, shear_seed.x)
                 + shear_phase.w * points_of_phase(matter, shear_phase.y, shear_seed.y);
    float depth = (matter.radius - disk_r_in) / (disk_r_out - disk_r_in);
    float taper = smoothstep(0.0, disk_point_field_taper_inside, depth) * (1.0 - smoothstep(1.0 - disk_point_field_taper_outside, 1.0, depth));
    float bias = pow(disk_r_in / matter.radius, disk_point_field_inward_bias) * (1.0 + disk_point_field_inward_bias);
    matter.density *= mix(1.0, points * taper * bias, disk_point_field_share);
    return matter;
}
