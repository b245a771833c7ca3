/*---
label = "Nyström 5"
summary = "Runge–Kutta–Nyström: fifth order in four evaluations, as the stages move places alone. Forces must depend on places alone."
source = "Nyström 1925; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.14"
slot = "integrator"
rank = 7
order = 5
evaluations = 4
second_order = true
---*/

// Stages add h² Σ a_j k_j to a drift: what needs the newest force comes last.
State integrator_step(Orbit orbit, State s, float h) {
    float h2 = h * h;
    State k1 = ray_rhs(orbit, s);
    State k2 = ray_rhs(orbit, state_push(state_drift(s, 0.2 * h), 0.02 * h2, k1));
    State k3 = ray_rhs(orbit, state_push(state_push(state_drift(s, h * (2.0 / 3.0)), h2 * (-1.0 / 27.0), k1), h2 * (7.0 / 27.0), k2));
    State whole = state_drift(s, h);
    State k4 = ray_rhs(orbit, state_push(state_push(state_push(whole, 0.3 * h2, k1), h2 * (-2.0 / 35.0), k2), h2 * (9.0 / 35.0), k3));
    State next = state_push(state_push(state_push(whole, h2 * (1.0 / 24.0), k1), h2 * (25.0 / 84.0), k2), h2 * (9.0 / 56.0), k3);
    return state_kick(state_kick(state_kick(state_kick(next, h * (1.0 / 24.0), k1), h * (125.0 / 336.0), k2), h * (27.0 / 56.0), k3), h * (5.0 / 48.0), k4);
}
