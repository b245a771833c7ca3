/*---
label = "Flat"
summary = "Straight rays and a black ball of the horizon's size: what there would be to see without gravity; the yardstick of cost."
source = "Euclid"
slot = "ray_model"
rank = 4
kind = "closed"
tells_paths = true
space_time = "flat"
spins = true
exact = true
tilted_disk = true
---*/

#include "common/straight.glsl"

Hits trace_ray(RayStart start) {
    return straight_hits(start, 0.5 * hole_w_factors.x);
}
