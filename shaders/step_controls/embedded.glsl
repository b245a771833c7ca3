/*---
label = "Embedded"
summary = "The integrator's own error estimate sets the next step; a step above the tolerance is tried again, shorter."
source = "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.4"
slot = "step_control"
rank = 6
adapts = true
needs_pair = true

[parameters.tolerance]
default = 1e-5
range = [1e-7, 0.1]
unit = "rad"
help = "Largest error allowed in one step, about the angle it makes. Below 1e-6 float32 rounding is what is measured."
---*/
#define STEP_ADAPTS
const float STEP_SHORTEST = 1e-3;  // of the longest: taken whatever the error

State adapted_step(Orbit orbit, State s, inout float trial, out float h) {
    float longest = ray_longest_step(orbit, s);
    h = min(trial, longest);
    State lower;
    State next = integrator_pair(orbit, s, h, lower);
    float error = state_difference(orbit, next, lower) / rays_embedded_tolerance;
    bool good = error <= 1.0 || h < STEP_SHORTEST * longest;
    trial = h * clamp(0.9 * pow(max(error, 1e-6), -INTEGRATOR_ERROR_POWER), 0.2, 4.0);
    if (good) return next;
    h = 0.0;
    return s;
}
