/*---
label = "Fixed"
summary = "Every step has the same length."
source = "BlackHoleGPU (docs/sources.md); Weiskopf, Schafhitzel & Ertl 2004"
slot = "step_control"
rank = 2
fits = ["cartesian", "field"]
---*/

float step_size(Orbit orbit, State s) {
    return plan_step_length * ray_slowdown(s);
}
