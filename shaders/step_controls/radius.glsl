/*---
label = "Radius"
summary = "Steps in proportion to the radius, Δt₀ long at r = 3: short where light bends, long where it does not. In a field, in proportion to the length on which that changes."
source = "BlackHoleGPU (docs/sources.md) below r = 3; carried on outwards, so that far cameras are in reach"
slot = "step_control"
rank = 1
fits = ["cartesian", "field"]
---*/

float step_size(Orbit orbit, State s) {
#ifdef RAY_SCALED_STEP
    return RAY_SCALED_STEP(orbit, s);
#else
    return ray_plain_step(orbit, s);
#endif
}
