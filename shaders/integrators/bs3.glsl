/*---
label = "Bogacki–Shampine 3(2)"
summary = "Third order with an embedded second-order result, whose difference is the error estimate."
source = "Bogacki & Shampine 1989"
slot = "integrator"
rank = 5
order = 3
evaluations = 3
pair_evaluations = 4
---*/

const float INTEGRATOR_ERROR_POWER = 1.0 / 3.0;  // the estimate grows as h³

State integrator_pair(Orbit orbit, State s, float h, out State lower) {
    State k1 = ray_rhs(orbit, s);
    State k2 = ray_rhs(orbit, state_step(s, 0.5 * h, k1));
    State k3 = ray_rhs(orbit, state_step(s, 0.75 * h, k2));
    State next = state_step(state_step(state_step(s, h * (2.0 / 9.0), k1), h / 3.0, k2), h * (4.0 / 9.0), k3);
    State k4 = ray_rhs(orbit, next);
    lower = state_step(state_step(state_step(state_step(s, h * (7.0 / 24.0), k1), h * 0.25, k2), h / 3.0, k3), h * 0.125, k4);
    return next;
}

State integrator_step(Orbit orbit, State s, float h) {
    State lower;  // not asked for: the compiler drops what only it needs
    return integrator_pair(orbit, s, h, lower);
}
