/*---
label = "Post-Newtonian"
summary = "Wrong, kept as published: x'' = −(M/r³) x (1 + 3h²/r²) bends light half too much far away (6M/b for 4M/b), and the observer's frame is skipped."
source = "a Python viewer after rossning92/Blackhole (docs/sources.md)"
slot = "ray_model"
rank = 8
kind = "differential"
marches_in = "cartesian"
step_control = "radius"
space_time = "flat"
spins = false
second_order = true
exact = false
tilted_disk = true
---*/
// The second term alone is light in Schwarzschild; the first is what a slow mass would feel, and light at |v| = 1 feels it too here.

float ray_twist_strength() {
    return 0.0;
}

float ray_newtonian_pull() {
    return 0.5;
}

float ray_drag() {
    return 0.0;
}

#include "common/cartesian.glsl"
