/*---
label = "Mino"
summary = "A fixed angular step κ in Mino time, in which every orbit is about one oscillation."
source = "docs/physics.md"
slot = "step_control"
rank = 3
fits = ["mino"]
---*/

float step_size(Orbit orbit, State s) {
    return ray_plain_step(orbit, s);
}
