/*---
label = "Sphere"
summary = "A sphere, at rest or on its way round the hole: a moon, a star, or, about the origin and larger than the hole, a neutron star."
source = "Weiskopf, Schafhitzel & Ertl 2004"
slot = "thing"
rank = 1
moves = true
round = true
surface = true
meets = "crossing"
reach = ["radius"]

[parameters.radius]
default = 1.0
range = [0.001, 100.0]
unit = "r_s"
help = "Its radius."

---*/
#include "common/rotation.glsl"
#include "common/colour.glsl"
#include "common/surface.glsl"
#include "common/sphere.glsl"

float thing_sphere_crossing(int i, vec3 x, vec3 y, out bool enters) {
    vec4 bound = thing_sphere_bound(i);
    return sphere_crossing(bound.xyz, bound.w, x, y, enters);
}

Light thing_sphere_light(int i, Sight sight) {
    vec4 bound = thing_sphere_bound(i), attitude = thing_sphere_attitude(i);
    vec3 arm = sight.place - bound.xyz;
    Painted spot = globe_place(unturned(attitude, arm), unturned(attitude, sight.right), unturned(attitude, sight.up));
    vec3 velocity = thing_sphere_velocity(i).xyz + cross(thing_sphere_spin(i).xyz, arm);
    return Light(surface_radiance(thing_sphere_finish(i), spot, sight, arm / bound.w, velocity), vec3(0.0));
}
