/*---
label = "Slab"
summary = "A disk with depth, |z| < h, of sheared clouds: density (1 − m) exp(−z²/2h²), m from 0 at the inner edge to 1 at the outer one."
source = "BlackHoleGPU (docs/sources.md): its volumetric disk, octave i of simplex noise at frequency i² · scale, alternate octaves turning opposite ways, both families of lanes, grain at 18 times the scale"
slot = "medium"
rank = 4
changes = true
parts = ["lanes"]
reach = ["outer_radius", "height"]
thickness = "height"
increasing = ["inner_radius", "outer_radius"]

[parameters]
inner_radius = { default = 3.0, range = [0.5, 500.0], unit = "r_s", help = "Its inner edge." }
outer_radius = { default = 12.0, range = [0.5, 1000.0], unit = "r_s", help = "Its outer edge, where it has thinned out." }
height = { default = 0.0, range = [0.0, 10.0], unit = "r_s", help = "h, half of its thickness; 0: disk.thickness." }
depth = { default = 2.0, range = [0.0, 100.0], unit = "1/r_s", help = "Optical depth of 1 r_s where it is densest, in its own frame." }
brightness = { default = 1.0, range = [0.0, 100.0], unit = "×", help = "Radiance that a very deep one has at its inner edge, in its own frame." }
temperature_k = { default = 6500.0, range = [1000.0, 40000.0], unit = "K", help = "Temperature at its inner edge; it falls as r^(−3/4)." }
octaves = { default = 3, range = [0, 5], help = "How many octaves of clouds are multiplied; 0 leaves it smooth." }
contrast = { default = 2.0, range = [0.0, 4.0], unit = "×", help = "Of each octave; 1 as published, between nothing and twice the mean." }
frequency = { default = 0.68, range = [0.01, 5.0], unit = "1/r_s", help = "Frequency of the coarsest octave." }
lanes = { default = 0.0, range = [0.0, 3.0], unit = "×", help = "Contrast of two families of lanes, which drift through the flow in opposite senses; 1 as published." }
grain = { default = 0.0, range = [0.0, 6.0], unit = "×", help = "Contrast of the finest grain; 1 as published, 0.85 to 1.15." }
speed = { default = 0.7, range = [0.0, 5.0], unit = "×", help = "How fast the clouds turn; 1 is the Keplerian rate, at which the matter that shines turns always." }
---*/
#include "common/rotation.glsl"
#include "common/colour.glsl"
#include "common/solid_noise.glsl"
#include "common/lane_waves.glsl"

const float MOST_LANES = 24.0;       // round the hole, at the inner edge
const float GRAIN_FREQUENCY = 18.0;  // over that of the coarsest octave
const float FINEST_KEPT = 0.8;       // of its features, in widths that are seen as one; those over 0.3 fade

float medium_slab_distance(int i, vec3 x) {
    float out_from_axis = length(x.xy);
    float beside = max(medium_slab_inner_radius(i) - out_from_axis, out_from_axis - medium_slab_outer_radius(i));
    return max(beside, abs(x.z) - medium_slab_height(i));
}

// Fine enough for clouds and lanes, but where they are finer than a third of its height.
float medium_slab_scale(int i, vec3 x) {
    float octaves = medium_slab_contrast(i) > 0.0 ? float(medium_slab_octaves(i)) : 0.0;
    float finest = medium_slab_frequency(i) * max(octaves * octaves, medium_slab_grain(i) > 0.0 ? GRAIN_FREQUENCY : 0.0);
    float out_from_axis = length(x.xy), finer = 2.0 / max(finest, 1e-6);
    if (medium_slab_lanes(i) > 0.0) finer = min(finer, 0.5 * out_from_axis / MOST_LANES * LANE_TURN);
    float clouds = max(finer, medium_slab_height(i) / 3.0);
    return min(min(2.0 * medium_slab_height(i), clouds), out_from_axis);
}

// Circular orbits' rate, rad per r_s/c, with the hole.
float slab_rate(float out_from_axis) {
    float x = 2.0 * out_from_axis;
    return (hole_spin < 0.0 ? -2.0 : 2.0) / (x * sqrt(x) + abs(hole_spin));
}

// What the clouds of a slab are; read once, as a parameter is a texel.
struct Clouds {
    int octaves;
    float contrast, first, grain;  // `first`: frequency of the coarsest octave
};

// Density of the lanes of one pattern of that age, mean 1; `share` is 0 on the inner edge, 1 on the outer one.
float slab_lanes(vec3 x, float share, float turned, float age, float width, float seed) {
    float out_from_axis = max(length(x.xy), 1e-4);
    float waver = solid_noise(vec3(0.1 * out_from_axis, 3.0 * x.z, 0.05 * age), uint(seed) * 16u + 14u);
    return lanes_density(LanePlace(x.xy / out_from_axis, vec2(width / out_from_axis), share, turned, 1.0, waver), seed);
}

// Density of the clouds of one pattern, mean 1, turned by `turned` radians; what is finer than `width` is not there.
float slab_clouds(Clouds clouds, vec3 x, float turned, float width, uint seed) {
    vec2 turn = cos_sin(-turned);
    vec3 onwards = vec3(rotate(x.xy, turn), x.z), forwards = onwards, backwards = vec3(rotate(x.xy, vec2(turn.x, -turn.y)), x.z);
    float density = 1.0, wound = width * (1.0 + 1.5 * abs(turned)), octave = 1.0;
    // Finer ones than are kept are their mean, 1: they are not looked up. The grain is one more round: a branch of its own would run always (docs/llvmpipe.md).
    float octaves = min(float(clouds.octaves), floor(sqrt(FINEST_KEPT / max(clouds.first * wound, 1e-6))));
    float rounds = octaves + (clouds.grain > 0.0 && clouds.first * GRAIN_FREQUENCY * wound < FINEST_KEPT ? 1.0 : 0.0);
    if (rounds > 0.0) do {
        bool grains = octave > octaves;
        float frequency = clouds.first * (grains ? GRAIN_FREQUENCY : octave * octave), kept = clamp(2.0 * (FINEST_KEPT - frequency * wound), 0.0, 1.0);
        float contrast = grains ? 0.15 * clouds.grain : clouds.contrast;
        density *= max(1.0 + contrast * kept * solid_noise(frequency * (grains ? onwards : forwards), seed + (grains ? 13u : uint(octave))), 0.0);
        vec3 swapped = forwards;
        forwards = backwards;
        backwards = swapped;
        octave += 1.0;
    } while (octave <= rounds);
    return density;
}

// Of clouds and lanes, mean 1.
float medium_slab_pattern(int i, vec3 x, float footprint) {
    float out_from_axis = length(x.xy), inner = medium_slab_inner_radius(i);
    Clouds shape = Clouds(medium_slab_octaves(i), medium_slab_contrast(i), medium_slab_frequency(i), medium_slab_grain(i));
    float width = max(footprint, 0.25 * plan_medium_step * medium_slab_scale(i, x));
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw));  // two patterns mixed: the contrast of one
    uvec2 seeds = uvec2(shear_seed.xy) * 16u;
    vec2 turned = medium_slab_speed(i) * slab_rate(out_from_axis) * shear_phase.xy;
    vec2 clouds = vec2(slab_clouds(shape, x, turned.x, width, seeds.x), slab_clouds(shape, x, turned.y, width, seeds.y));
#if MEDIUM_SLAB_LANES  // a branch would run always (docs/llvmpipe.md)
    float share = (out_from_axis - inner) / max(medium_slab_outer_radius(i) - inner, 1e-4);
    vec2 lanes = vec2(slab_lanes(x, share, turned.x, shear_phase.x, width, shear_seed.x), slab_lanes(x, share, turned.y, shear_phase.y, width, shear_seed.y));
    clouds *= max(1.0 + medium_slab_lanes(i) * (lanes - 1.0), 0.0);
#endif
    return max(1.0 + dot(weights, clouds - 1.0), 0.0);
}

Matter medium_slab_matter(int i, Sight sight) {
    vec3 x = sight.place;
    float out_from_axis = length(x.xy), inner = medium_slab_inner_radius(i), height = x.z / medium_slab_height(i);
    float share = (out_from_axis - inner) / max(medium_slab_outer_radius(i) - inner, 1e-4);
    float density = max(1.0 - share, 0.0) * exp(-0.5 * height * height), rate = slab_rate(out_from_axis);
    float shift = emitted_shift(sight, rate * vec3(-x.y, x.x, 0.0)), warmth = inner / max(out_from_axis, 1e-6);
    vec3 colour = blackbody_colour(medium_slab_temperature_k(i) * pow(warmth, 0.75) * shift * sight.energy);
    vec3 absorption = vec3(density * medium_slab_depth(i));
    return Matter(absorption * medium_slab_brightness(i) * warmth * warmth * warmth * colour, absorption, shift);
}
