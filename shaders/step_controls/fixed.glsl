/*---
label = "Fixed"
summary = "Every step has the same length."
source = "S1, S2"
slot = "step_control"
rank = 2
fits = ["cartesian"]
---*/

float step_size(Orbit orbit, State s) {
    return plan_step_length * ray_slowdown(s);
}
