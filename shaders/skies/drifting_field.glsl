/*---
label = "Drifting field"
summary = "BlackHoleGPU's sky: specks of noise that turn and drift with time."
source = "BlackHoleGPU's report, 2025; simplex noise by Gustavson 2005 after Perlin 2001"
slot = "sky"
rank = 27
changes = true

[parameters.brightness]
default = 1.0
range = [0.0, 20.0]
unit = "×"
help = "Of the specks."

[parameters.scale]
default = 80.0
range = [5.0, 300.0]
help = "Of the noise: about as many specks' places a radian."

[parameters.threshold]
default = 0.88
range = [0.5, 0.92]
help = "Of the noise, −1 to 1, from which on a speck shines; the higher, the fewer."

[parameters.turn_rate]
default = 0.02
range = [-0.5, 0.5]
unit = "rad·c/r_s"
help = "How fast the field turns about the hole's axis."

[parameters.drift]
default = 1.0
range = [-20.0, 20.0]
unit = "×"
help = "How fast it drifts through the noise besides: as many times (0.005, 0.003, 0) a time of r_s/c."

[parameters.frequency_shift]
default = false
help = "Shift its brightness (as the fourth power) by the observer's place and motion, and its colours as those of light from 6500 K. As published it does not."

[numbers.drifting_field_turn]
make = "blackhole_gl.rendering.drifting_field:turn"
of = ["time", "sky.drifting_field.turn_rate"]
type = "vec2"

[numbers.drifting_field_cell]
make = "blackhole_gl.rendering.drifting_field:cell"
of = ["time", "sky.drifting_field.drift", "sky.drifting_field.scale"]
type = "vec4"

[numbers.drifting_field_shift]
make = "blackhole_gl.rendering.drifting_field:shift"
of = ["time", "sky.drifting_field.drift", "sky.drifting_field.scale"]
type = "vec4"
---*/
#include "common/noise.glsl"
#include "common/rotation.glsl"
#include "common/shifted_light.glsl"

const vec3 FIELD_COLOUR = vec3(0.9, 0.95, 1.0);
const float FIELD_FINE = 0.15, FIELD_WIDE = 0.5; // side of a footprint over the noise's features, between which specks give way to their mean

// What a corner of the lattice adds at the place `offset` from it: the gradient is towards the middle of one of a cube's twelve edges.
float field_corner(vec3 offset, ivec3 corner) {
    int edge = int((hash_lattice(corner, 0u) >> 8u) % 12u);
    vec2 along = edge < 4 ? offset.xy : (edge < 8 ? offset.xz : offset.yz);
    float fall = max(0.6 - dot(offset, offset), 0.0);
    fall *= fall;
    return fall * fall * (((edge & 1) == 0 ? along.x : -along.x) + ((edge & 2) == 0 ? along.y : -along.y));
}

// Simplex noise, −1…1, on a lattice that is moved by whole cells.
float field_noise(vec3 place, ivec3 moved) {
    vec3 cell = floor(place + (place.x + place.y + place.z) * (1.0 / 3.0));
    vec3 offset = place - cell + (cell.x + cell.y + cell.z) * (1.0 / 6.0);
    vec3 above = step(offset.yzx, offset), below = 1.0 - above.zxy; // x ≥ y, y ≥ z, z ≥ x; x > z, y > x, z > y
    vec3 first = min(above, below), second = max(above, below);
    ivec3 corner = ivec3(cell) + moved;
    float sum = field_corner(offset, corner) + field_corner(offset - first + 1.0 / 6.0, corner + ivec3(first))
              + field_corner(offset - second + 1.0 / 3.0, corner + ivec3(second)) + field_corner(offset - 0.5, corner + 1);
    return 32.0 * sum;
}

vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy) {
    vec3 turned = vec3(rotate(direction.xy, drifting_field_turn), direction.z);
    float noise = field_noise(sky_drifting_field_scale * turned + drifting_field_shift.xyz, ivec3(drifting_field_cell.xyz));
    float span = 1.0 - sky_drifting_field_threshold;
    float speck = max(noise - sky_drifting_field_threshold, 0.0) / span;
    float few = min(span * (1.0 / 0.3), 1.0);
    float mean = 0.0955 * span * span * few * (2.0 - few); // of the specks; within a tenth of that of twelve million places, at every threshold
    float haze = smoothstep(FIELD_FINE, FIELD_WIDE, sky_drifting_field_scale * sqrt(max(dot(right, right), dot(up, up))));
    vec3 light = mix(speck * speck, mean, haze) * sky_drifting_field_brightness * FIELD_COLOUR;
#if SKY_DRIFTING_FIELD_FREQUENCY_SHIFT
    light = shifted_light(light, energy);
#endif
    return light;
}
