/*---
label = "Post-Newtonian with drag"
summary = "Wrong, kept as published: the post-Newtonian force and −(6M/r³) v × J beside it, in place of Kerr; the horizon has Kerr's radius."
source = "a Python viewer after rossning92/Blackhole (docs/sources.md)"
slot = "ray_model"
rank = 9
kind = "differential"
marches_in = "cartesian"
step_control = "radius"
space_time = "flat"
spins = true
second_order = false  # the force depends on the velocity
march_bound = 120.0   # r_s: the drag is finished to first order only, so further out
exact = false
---*/
// J = (0, 0, a M) with M = 1/2 and a = a*/2: k = 6 M a M = 3a*/4. A backward ray's v turns the sign of a photon's, and with it the
// flattened side of the shadow comes out where the disk approaches, as it should. h is that of the start: the drag changes |x × v|.
// From cameras within r = 2 some rays have less than the escape speed: they go round until they fall in, or stay without a fate.

float ray_twist_strength() {
    return 0.0;
}

float ray_newtonian_pull() {
    return 0.5;
}

float ray_drag() {
    return 0.75 * hole_gravity_strength * hole_spin;
}

#include "common/cartesian.glsl"
