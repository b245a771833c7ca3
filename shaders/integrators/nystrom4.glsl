/*---
label = "Nyström 4"
summary = "Runge–Kutta–Nyström: fourth order in three evaluations, as the stages move places alone. Forces must depend on places alone."
source = "Nyström 1925; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.14"
slot = "integrator"
rank = 6
order = 4
evaluations = 3
second_order = true
---*/

// Stages add h² Σ a_j k_j to a drift: what needs the newest force comes last.
State integrator_step(Orbit orbit, State s, float h) {
    float h2 = h * h;
    State k1 = ray_rhs(orbit, s);
    State k2 = ray_rhs(orbit, state_push(state_drift(s, 0.5 * h), 0.125 * h2, k1));
    State whole = state_drift(s, h);
    State k3 = ray_rhs(orbit, state_push(whole, 0.5 * h2, k2));
    State next = state_push(state_push(whole, h2 * (1.0 / 6.0), k1), h2 * (1.0 / 3.0), k2);
    return state_kick(state_kick(state_kick(next, h * (1.0 / 6.0), k1), h * (2.0 / 3.0), k2), h * (1.0 / 6.0), k3);
}
