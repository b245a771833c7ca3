/*---
label = "Radius"
summary = "Steps in proportion to the radius, Δt₀ long at r = 3: short where light bends, long where it does not."
source = "S1 below r = 3; carried on outwards, so that far cameras are in reach"
slot = "step_control"
rank = 1
fits = ["cartesian"]
---*/

// Inside r = G, where only the artistic horizon sizes let a ray be, the angle turned per length grows as G/r.
float step_size(Orbit orbit, State s) {
    float r = ray_radius(s);
    return plan_step_length * r * min(1.0, r / hole_gravity_strength) / 3.0;
}
