/*---
label = "Radial potential"
summary = "Rays pulled as slow bodies are towards a centre, by Newton's, Yukawa's or a compact potential, within a sphere; there is no hole."
source = "Weiskopf, Schafhitzel & Ertl 2004; Newton 1687; Yukawa 1935"
slot = "ray_model"
rank = 22
kind = "differential"
marches_in = "field"
step_control = "radius"
space_time = "flat"
spins = false
second_order = true
exact = true
tilted_disk = true
field = true
harder_with = ["strength"]
milder_with = ["core"]

[parameters]
law = { default = "newton", options = ["newton", "yukawa", "compact"], help = "Pull at distance r from the centre: ζ/r², ζ(1 + μr)e^(−μr)/r², or ζ(2r³/R³ − 3r²/R² + 1) up to R and none beyond." }
strength = { default = 0.5, range = [-10.0, 10.0], help = "ζ; negative pushes away. A ray begins with speed 1, at which ζ is that of Newton's potential in r_s, and of the compact one in 1/r_s." }
screening = { default = 0.3, range = [0.0, 10.0], unit = "1/r_s", help = "μ of Yukawa's potential; 0 is Newton's." }
extent = { default = 8.0, range = [0.1, 1000.0], unit = "r_s", help = "R of the compact potential." }
core = { default = 0.2, range = [0.0, 10.0], unit = "r_s", help = "c of r = √(d² + c²) with the distance d from the centre, so that nothing is infinite there; 0: r = d." }
x = { default = 0.0, range = [-100.0, 100.0], unit = "r_s", help = "Place of the centre." }
y = { default = 0.0, range = [-100.0, 100.0], unit = "r_s", help = "Place of the centre." }
z = { default = 0.0, range = [-100.0, 100.0], unit = "r_s", help = "Place of the centre." }
---*/

// e^(−y) for y ≥ 0, to 1e-7: 2^(−k) e^(−f) with f in 0 … ln 2.
float decay(float y) {
    float k = floor(min(y, 80.0) * 1.44269504);
    float f = (min(y, 80.0) - k * 0.693145752) - k * 1.42860677e-6;
    float fraction = 1.0 / (1.0 + f * (1.0 + f * (0.5 + f * (1.0 / 6.0 + f * (1.0 / 24.0 + f * (1.0 / 120.0 + f * (1.0 / 720.0 + f / 5040.0)))))));
    return fraction * intBitsToFloat((127 - int(k)) << 23);
}

vec3 from_centre(vec3 x) {
    return x - vec3(rays_potential_x, rays_potential_y, rays_potential_z);
}

float softened(vec3 from) {
    return sqrt(dot(from, from) + rays_potential_core * rays_potential_core + 1e-12);
}

vec3 field_acceleration(vec3 x, vec3 v) {
    vec3 from = from_centre(x);
    float r = softened(from);
#if RAYS_POTENTIAL_LAW_COMPACT
    float q = min(r / rays_potential_extent, 1.0);
    float pull = 1.0 + q * q * (2.0 * q - 3.0);
#elif RAYS_POTENTIAL_LAW_YUKAWA
    float y = rays_potential_screening * r;
    float pull = (1.0 + y) * decay(y) / (r * r);
#else
    float pull = 1.0 / (r * r);
#endif
    return (-rays_potential_strength * pull / r) * from;
}

#define FIELD_LENGTH field_length
float field_length(vec3 x, vec3 v) {
    return max(softened(from_centre(x)), 0.2) / 3.0;
}

#define FIELD_ENERGY field_energy
float field_energy(vec3 x, vec3 v) {
    float r = softened(from_centre(x));
#if RAYS_POTENTIAL_LAW_COMPACT
    float q = min(r / rays_potential_extent, 1.0);
    float height = rays_potential_extent * q * (1.0 + q * q * (0.5 * q - 1.0));
#elif RAYS_POTENTIAL_LAW_YUKAWA
    float height = -decay(rays_potential_screening * r) / r;
#else
    float height = -1.0 / r;
#endif
    return 0.5 * dot(v, v) + rays_potential_strength * height;
}

#include "common/field.glsl"
