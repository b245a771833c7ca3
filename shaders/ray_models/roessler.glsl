/*---
label = "Rössler field"
summary = "Rays pushed by Rössler's dynamical system taken as a force, within a sphere; there is no hole."
source = "Weiskopf, Schafhitzel & Ertl 2004; Rössler 1976"
slot = "ray_model"
rank = 21
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
strength = { default = 0.005, range = [0.0, 0.1], unit = "1/r_s", help = "What the field is multiplied by; 0 leaves rays straight." }
alpha = { default = 0.375, range = [-5.0, 5.0], help = "α in (−y − z, x + αy, β + z(x − γ))." }
beta = { default = 2.0, range = [-10.0, 10.0], help = "β there." }
gamma = { default = 4.0, range = [-20.0, 20.0], help = "γ there." }
---*/
// The paper prints −x − z for the first component: Rössler's own is −y − z.

vec3 field_acceleration(vec3 x, vec3 v) {
    vec3 f = vec3(-x.y - x.z, x.x + rays_roessler_alpha * x.y, rays_roessler_beta + x.z * (x.x - rays_roessler_gamma));
    return rays_roessler_strength * f;
}

#include "common/field.glsl"
