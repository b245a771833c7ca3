/*---
label = "Kerr-like"
summary = "Schwarzschild orbits whose propagation basis is twisted about the spin axis by the Lense–Thirring rate: a picture of dragging, not Kerr."
source = "an orbital-plane renderer (docs/sources.md)"
slot = "ray_model"
rank = 3
kind = "differential"
marches_in = "cartesian"
step_control = "radius"
space_time = "schwarzschild"
spins = true
second_order = true
exact = false

[parameters.drag]
default = 1.0
range = [0.0, 10.0]
unit = "×"
help = "k in the twist rate ω = k a/r³ with a half the spin, the rate of the twist; 1 is the Lense–Thirring rate far from the hole."
physical = 1.0

[parameters.twist]
default = true
help = "Dragging turns the plane of a ray's orbit."

[parameters.flow]
default = false
help = "Dragging carries the disk's matter round faster, by the same rate: its Doppler shift and beaming."

[parameters.pattern]
default = false
help = "Dragging carries the pattern on the disk round faster, by the same rate."
---*/

// The twist turns place and velocity alike, so that L_z stays what it was and the twist is a quadrature along the orbit.
float ray_twist_strength() {
#if RAYS_KERR_LIKE_TWIST
    return 0.5 * rays_kerr_like_drag * hole_spin;
#else
    return 0.0;
#endif
}

float ray_newtonian_pull() {
    return 0.0;
}

float ray_drag() {
    return 0.0;
}

#include "common/cartesian.glsl"
