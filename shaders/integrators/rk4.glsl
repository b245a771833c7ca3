/*---
label = "Runge–Kutta 4"
summary = "The classical scheme of fourth order."
source = "Kutta 1901"
slot = "integrator"
rank = 1
order = 4
evaluations = 4
---*/

State integrator_step(Orbit orbit, State s, float h) {
    State k1 = ray_rhs(orbit, s);
    State k2 = ray_rhs(orbit, state_step(s, 0.5 * h, k1));
    State k3 = ray_rhs(orbit, state_step(s, 0.5 * h, k2));
    State k4 = ray_rhs(orbit, state_step(s, h, k3));
    return state_step(s, h / 6.0, state_step(state_step(k1, 2.0, state_step(k2, 1.0, k3)), 1.0, k4));
}
