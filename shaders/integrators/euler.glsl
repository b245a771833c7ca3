/*---
label = "Euler"
summary = "One evaluation a step, first order: the scheme of most shaders on the web."
source = "Weiskopf, Schafhitzel & Ertl 2004; Euler 1768"
slot = "integrator"
rank = 2
order = 1
evaluations = 1
---*/

State integrator_step(Orbit orbit, State s, float h) {
    return state_step(s, h, ray_rhs(orbit, s));
}
