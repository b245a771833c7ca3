/*---
label = "Velocity Verlet"
summary = "Half a kick, a drift, half a kick: second order, and errors of conserved quantities that do not grow. Forces must depend on places alone."
source = "BlackHoleGPU (docs/sources.md); Verlet 1967"
slot = "integrator"
rank = 3
order = 2
evaluations = 2
second_order = true
---*/

State integrator_step(Orbit orbit, State s, float h) {
    State drifted = state_drift(state_kick(s, 0.5 * h, ray_rhs(orbit, s)), h);
    return state_kick(drifted, 0.5 * h, ray_rhs(orbit, drifted));
}
