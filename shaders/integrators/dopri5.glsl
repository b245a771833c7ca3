/*---
label = "Dormand–Prince 5(4)"
summary = "Fifth order with an embedded fourth-order result, whose difference is the error estimate."
source = "Dormand & Prince 1980"
slot = "integrator"
rank = 4
order = 5
evaluations = 6
pair_evaluations = 7
---*/

const float INTEGRATOR_ERROR_POWER = 0.2;  // the estimate grows as h⁵

State integrator_pair(Orbit orbit, State s, float h, out State lower) {
    State k1 = ray_rhs(orbit, s);
    State k2 = ray_rhs(orbit, state_step(s, 0.2 * h, k1));
    State k3 = ray_rhs(orbit, state_step(state_step(s, h * (3.0 / 40.0), k1), h * (9.0 / 40.0), k2));
    State at = state_step(state_step(state_step(s, h * (44.0 / 45.0), k1), h * (-56.0 / 15.0), k2), h * (32.0 / 9.0), k3);
    State k4 = ray_rhs(orbit, at);
    at = state_step(state_step(s, h * (19372.0 / 6561.0), k1), h * (-25360.0 / 2187.0), k2);
    at = state_step(state_step(at, h * (64448.0 / 6561.0), k3), h * (-212.0 / 729.0), k4);
    State k5 = ray_rhs(orbit, at);
    at = state_step(state_step(s, h * (9017.0 / 3168.0), k1), h * (-355.0 / 33.0), k2);
    at = state_step(state_step(state_step(at, h * (46732.0 / 5247.0), k3), h * (49.0 / 176.0), k4), h * (-5103.0 / 18656.0), k5);
    State k6 = ray_rhs(orbit, at);
    State next = state_step(state_step(s, h * (35.0 / 384.0), k1), h * (500.0 / 1113.0), k3);
    next = state_step(state_step(state_step(next, h * (125.0 / 192.0), k4), h * (-2187.0 / 6784.0), k5), h * (11.0 / 84.0), k6);
    State k7 = ray_rhs(orbit, next);
    lower = state_step(state_step(state_step(next, h * (-71.0 / 57600.0), k1), h * (71.0 / 16695.0), k3), h * (-71.0 / 1920.0), k4);
    lower = state_step(state_step(state_step(lower, h * (17253.0 / 339200.0), k5), h * (-22.0 / 525.0), k6), h * (1.0 / 40.0), k7);
    return next;
}

State integrator_step(Orbit orbit, State s, float h) {
    State lower;  // not asked for: the compiler drops what only it needs
    return integrator_pair(orbit, s, h, lower);
}
