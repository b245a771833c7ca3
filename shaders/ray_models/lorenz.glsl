/*---
label = "Lorenz field"
summary = "Rays pushed by Lorenz's dynamical system taken as a force, within a sphere; there is no hole."
source = "Weiskopf, Schafhitzel & Ertl 2004; Lorenz 1963"
slot = "ray_model"
rank = 20
kind = "differential"
marches_in = "field"
step_control = "fixed"
space_time = "flat"
spins = false
second_order = true
exact = true
tilted_disk = true
field = true
harder_with = ["strength"]

[parameters]
strength = { default = 5e-4, range = [0.0, 0.1], unit = "1/r_s", help = "What the field is multiplied by; 0 leaves rays straight." }
sigma = { default = 10.0, range = [0.0, 50.0], help = "σ, the Prandtl number of Lorenz's convection." }
rho = { default = 28.0, range = [0.0, 100.0], help = "ρ, its Rayleigh number over the critical one." }
beta = { default = 2.6666667, range = [0.0, 20.0], help = "β, about its cells' width over their height." }
---*/

vec3 field_acceleration(vec3 x, vec3 v) {
    vec3 f = vec3(rays_lorenz_sigma * (x.y - x.x), rays_lorenz_rho * x.x - x.y - x.x * x.z, x.x * x.y - rays_lorenz_beta * x.z);
    return rays_lorenz_strength * f;
}

#include "common/field.glsl"
