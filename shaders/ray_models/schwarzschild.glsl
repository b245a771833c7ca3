/*---
label = "Schwarzschild"
summary = "Exact null orbits of a hole without spin, marched in Cartesian space: x'' = −(3/2) G h² x/r⁵."
source = "Binet's equation u'' + u = (3/2) u² as a central force; BlackHoleGPU (docs/sources.md)"
slot = "ray_model"
rank = 2
kind = "differential"
marches_in = "cartesian"
step_control = "radius"
space_time = "schwarzschild"
spins = false
second_order = true
exact = true
tilted_disk = true
---*/

float ray_twist_strength() {
    return 0.0;
}

float ray_newtonian_pull() {
    return 0.0;
}

float ray_drag() {
    return 0.0;
}

#include "common/cartesian.glsl"
