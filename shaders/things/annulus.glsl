/*---
label = "Annulus"
summary = "A flat ring about the hole, in a plane of any tilt through it: it glows by itself, in sectors by turns bright and dim, and hides what is behind it."
source = "own"
slot = "thing"
reach = ["outer_radius"]
increasing = ["inner_radius", "outer_radius"]

[parameters.inner_radius]
default = 12.0
range = [1.0, 1000.0]
unit = "r_s"
help = "Inner edge."

[parameters.outer_radius]
default = 14.0
range = [1.0, 1000.0]
unit = "r_s"
help = "Outer edge."

[parameters.tilt_deg]
default = 30.0
range = [0.0, 180.0]
unit = "°"
help = "Angle between its axis and the spin axis."

[parameters.node_deg]
default = 0.0
range = [-180.0, 180.0]
unit = "°"
help = "Azimuth at which it rises through the equatorial plane."

[parameters.temperature_k]
default = 5000.0
range = [1000.0, 40000.0]
unit = "K"
help = "Of its surface, at rest."

[parameters.brightness]
default = 0.3
range = [0.0, 10.0]
help = "Of its bright sectors."

[parameters.sectors]
default = 24
range = [0, 360]
help = "How many sectors it has, bright and dim by turns; 0: all bright."
---*/
#include "common/rotation.glsl"
#include "common/colour.glsl"

// Unit vector along its axis.
vec3 annulus_axis(int i) {
    vec2 tilt = cos_sin(radians(thing_annulus_tilt_deg(i))), node = cos_sin(radians(thing_annulus_node_deg(i)));
    return vec3(tilt.y * node.y, -tilt.y * node.x, tilt.x);
}

float thing_annulus_distance(int i, vec3 x) {
    vec3 axis = annulus_axis(i);
    float height = dot(axis, x), radius = length(x - height * axis);
    float beside = max(max(thing_annulus_inner_radius(i) - radius, radius - thing_annulus_outer_radius(i)), 0.0);
    return (height < 0.0 ? -1.0 : 1.0) * length(vec2(height, beside));
}

Light thing_annulus_light(int i, Sight sight) {
    vec3 axis = annulus_axis(i);
    vec2 node = cos_sin(radians(thing_annulus_node_deg(i)));
    vec3 along = vec3(node, 0.0), across = cross(axis, along);
    float sector = floor(turns(dot(sight.place, along), dot(sight.place, across)) * float(thing_annulus_sectors(i)));
    float bright = mod(sector, 2.0) == 0.0 ? 1.0 : 0.3;
    float emitted = emitted_shift(sight, vec3(0.0)), seen = emitted * sight.beaming;
    vec3 colour = blackbody_colour(thing_annulus_temperature_k(i) * (emitted * sight.energy));
    return Light(colour * (bright * thing_annulus_brightness(i) * seen * seen * seen * seen), vec3(0.0));
}
