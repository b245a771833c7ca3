/*---
label = "Sphere"
summary = "A sphere, at rest or on its way round the hole: a moon, a star, or, about the origin and larger than the hole, a neutron star."
source = "Weiskopf, Schafhitzel & Ertl 2004"
slot = "thing"
rank = 1
moves = true
round = true
reach = ["radius"]

[parameters.radius]
default = 1.0
range = [0.001, 100.0]
unit = "r_s"
help = "Its radius."

[parameters.colour]
default = [0.85, 0.8, 0.7]
length = [3, 3]
element = { default = 1.0, range = [0.0, 1.0] }
help = "Red, green and blue of its surface, of the light that falls on it."
---*/

float thing_sphere_distance(int i, vec3 x) {
    vec4 bound = thing_sphere_bound(i);
    return distance(x, bound.xyz) - bound.w;
}

Light thing_sphere_light(int i, Sight sight) {
    vec4 bound = thing_sphere_bound(i);
    vec3 arm = sight.place - bound.xyz;
    float lit = 0.2 + 0.8 * max(dot(arm / bound.w, sight.towards), 0.0);
    float shift = emitted_shift(sight, thing_sphere_velocity(i).xyz + cross(thing_sphere_spin(i).xyz, arm)) * sight.energy;
    shift *= shift;
    return Light(thing_sphere_colour(i) * (lit * shift * shift), vec3(0.0));
}
