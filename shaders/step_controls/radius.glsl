/*---
label = "Radius"
summary = "Steps in proportion to the radius, Δt₀ long at r = 3: short where light bends, long where it does not."
source = "BlackHoleGPU (docs/sources.md) below r = 3; carried on outwards, so that far cameras are in reach"
slot = "step_control"
rank = 1
fits = ["cartesian"]
---*/

float step_size(Orbit orbit, State s) {
    return ray_plain_step(orbit, s);
}
