/*---
label = "Lamp"
summary = "A small ball that lights up the surfaces of other things, along straight lines."
source = "Weiskopf, Schafhitzel & Ertl 2004"
slot = "thing"
rank = 3
moves = true
round = true
shines = true
meets = "crossing"
reach = ["radius"]

[parameters.radius]
default = 0.2
range = [0.0, 100.0]
unit = "r_s"
help = "Of the ball that is seen; 0: the lamp itself is not seen."

[parameters.glow]
default = 2.0
range = [0.0, 1000.0]
help = "How bright the ball itself looks."
---*/
#include "common/sphere.glsl"

float thing_lamp_crossing(int i, vec3 x, vec3 y, out bool enters) {
    vec4 bound = thing_lamp_bound(i);
    return sphere_crossing(bound.xyz, bound.w, x, y, enters);
}

Light thing_lamp_light(int i, Sight sight) {
    float shift = emitted_shift(sight, thing_lamp_velocity(i).xyz) * sight.beaming;
    shift *= shift;
    return Light(thing_lamp_colour(i) * (thing_lamp_glow(i) * shift * shift), vec3(0.0));
}
