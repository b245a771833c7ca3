/*---
label = "Step doubling"
summary = "One step of h against two of h/2: above the tolerance h is halved and the step tried again, far below it h is doubled. Any integrator."
source = "Weiskopf, Schafhitzel & Ertl 2004"
slot = "step_control"
rank = 5
adapts = true
integrator_steps = 3

[parameters.tolerance]
default = 1e-4
range = [1e-7, 0.1]
unit = "rad"
help = "Largest difference allowed in one step, about the angle it makes. Below 1e-6 float32 rounding is what is measured."
[parameters.growth]
default = 0.02
range = [0.0001, 0.5]
unit = "×"
help = "Below this part of the tolerance the step is doubled."
---*/
#define STEP_ADAPTS
const float STEP_SHORTEST = 1e-3;  // of the longest: taken whatever the error

State adapted_step(Orbit orbit, State s, inout float trial, out float h) {
    float longest = ray_longest_step(orbit, s);
    h = min(trial, longest);
    State whole = integrator_step(orbit, s, h);
    State halves = integrator_step(orbit, integrator_step(orbit, s, 0.5 * h), 0.5 * h);
    float error = state_difference(orbit, whole, halves) / rays_doubling_tolerance;
    bool good = error <= 1.0 || h < STEP_SHORTEST * longest;
    trial = !good ? 0.5 * h : error < rays_doubling_growth ? 2.0 * h : h;
    if (good) return halves;
    h = 0.0;
    return s;
}
