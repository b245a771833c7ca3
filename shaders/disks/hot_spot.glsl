/*---
label = "Hot spot"
summary = "A bright patch that goes round with a circular orbit: Gaussian in angle and in the logarithm of the radius, kept in shape."
source = "the usual model of a flare close to a hole, as in Broderick & Loeb 2005; rigid, where shear would draw a real one out"
slot = "disk_layer"
rank = 80
enabled = false

[parameters.radius]
default = 5.0
range = [0.5, 20.0]
unit = "r_s"
help = "Radius of its orbit; never inside the innermost stable one."

[parameters.phase_deg]
default = 0.0
range = [-360.0, 360.0]
unit = "°"
help = "Azimuth at scene time 0, counter-clockwise seen from +z; in a tilted disk, from where its axis leans and its plane lies lowest."

[parameters.size]
default = 0.15
range = [0.01, 1.0]
help = "Standard deviation, as a part of the radius along it and outwards."

[parameters.brightness]
default = 8.0
range = [0.0, 1000.0]
unit = "×"
help = "Light that it adds in its middle, over that of the disk there."

[numbers.disk_spot]
make = "blackhole_gl.physics.hot_spot:place"
of = ["disk.hot_spot.radius", "disk.hot_spot.phase_deg", "disk.orbit", "disk.tilt_deg", "hole.spin", "rays.model", "rays.lensing", "time"]
type = "vec4"
---*/
#include "common/rotation.glsl"

// The part of a Gaussian of width `size` that a stretch `wide` of it leaves on average, and the width that it is then: (width², height).
vec2 spot_blurred(float size, float wide) {
    float square = size * size + wide * wide * (1.0 / 12.0);
    return vec2(square, size * inversesqrt(square));
}

DiskMatter disk_layer_hot_spot(DiskMatter matter) {
    vec2 outwards = spot_blurred(disk_hot_spot_size, matter.footprint.x), around = spot_blurred(disk_hot_spot_size, matter.footprint.y);
    float far = log(matter.radius / disk_spot.z);
#if RAYS_LIGHT_TRAVEL
    vec2 spot = rotate(disk_spot.xy, cos_sin(-disk_spot.w * seen_delay));
#else
    vec2 spot = disk_spot.xy;
#endif
    vec2 chord = matter.heading - spot;
    float depth = far * far / outwards.x + dot(chord, chord) / around.x;
    matter.gain *= 1.0 + disk_hot_spot_brightness * outwards.y * around.y * exp(-0.5 * depth);
    return matter;
}
