/*---
label = "Refraction"
summary = "Light in a medium whose refractive index changes from place to place, within a sphere: lenses, a mirage, an explosion; there is no hole."
source = "Weiskopf, Schafhitzel & Ertl 2004; Luneburg 1944; Maxwell 1854; Born & Wolf, Principles of Optics, 3.2"
slot = "ray_model"
rank = 23
kind = "differential"
marches_in = "field"
step_control = "radius"
space_time = "flat"
spins = false
second_order = true
exact = true
tilted_disk = true
field = true
harder_with = ["strength", "raggedness", "index"]
milder_with = ["width", "grain"]

[parameters]
medium = { default = "explosion", options = ["explosion", "mirage", "luneburg", "fish_eye", "linear"], help = "How n changes: a ragged shell, a hot floor in z = 0, Luneburg's lens, Maxwell's fish-eye, n² linear in z." }
size = { default = 6.0, range = [0.01, 1000.0], unit = "r_s", help = "Radius of the shell or of the lens, at which the fish-eye's n is half of what it is in its middle; height of the floor's hot air." }
strength = { default = 0.3, range = [-0.95, 5.0], help = "By how much n² is larger in the shell than 1; less above the floor than high up; larger for each r_s of height where it is linear. The lenses have none." }
width = { default = 1.0, range = [0.01, 100.0], unit = "r_s", help = "Thickness of the shell." }
raggedness = { default = 0.15, range = [0.0, 1.0], help = "How far the shell's radius wanders, in parts of it." }
grain = { default = 4.0, range = [0.1, 100.0], unit = "r_s", help = "Length over which it wanders." }
index = { default = 2.0, range = [1.0, 10.0], help = "n in the middle of the fish-eye." }
---*/
// d/ds(n dx/ds) = ∇n is x'' = ½∇n² by dσ = ds/n, with |x'| = n: no root, and a force that depends on places alone.
// A model of a medium gives ½∇n² and n² at x. Outside of the sphere n is what it is on it: rays are not broken there.
#include "common/waves.glsl"

#if RAYS_REFRACTION_MEDIUM_EXPLOSION
// How many widths x is from a shell whose radius wanders, u, behind its gradient.
vec4 from_shell(vec3 x) {
    float smoothing = 0.1 * rays_refraction_size, along = 1.0 / rays_refraction_grain, across = 1.0 / rays_refraction_width;
    float square = dot(x, x) + smoothing * smoothing, inverse = inversesqrt(square);
    vec4 wandering = waves(along * x) * vec4(vec3(along), 1.0) * (rays_refraction_size * rays_refraction_raggedness);
    return across * vec4(inverse * x - wandering.xyz, square * inverse - rays_refraction_size - wandering.w);
}

// n² = 1 + strength/(1 + u²)²
vec4 refraction(vec3 x) {
    vec4 shell = from_shell(x);
    float bell = 1.0 / (1.0 + shell.w * shell.w);
    return vec4((-2.0 * rays_refraction_strength * shell.w * bell * bell * bell) * shell.xyz, 1.0 + rays_refraction_strength * bell * bell);
}
#elif RAYS_REFRACTION_MEDIUM_MIRAGE
// n² = 1 − ½ strength (1 − z/√(z² + size²))
vec4 refraction(vec3 x) {
    float h = inversesqrt(x.z * x.z + rays_refraction_size * rays_refraction_size);
    float slope = rays_refraction_size * rays_refraction_size * h * h * h;
    return vec4(0.0, 0.0, 0.25 * rays_refraction_strength * slope, 1.0 - 0.5 * rays_refraction_strength * (1.0 - x.z * h));
}
#elif RAYS_REFRACTION_MEDIUM_LUNEBURG
// n² = 2 − r²/size² within; a lens as large as the sphere ends with it, and steps that pass over its rim find nothing that breaks off.
vec4 refraction(vec3 x) {
    float q = dot(x, x) / (rays_refraction_size * rays_refraction_size);
    return q < 1.0 || rays_refraction_size >= rays_field_radius ? vec4(-x / (rays_refraction_size * rays_refraction_size), 2.0 - q) : vec4(0.0, 0.0, 0.0, 1.0);
}
#elif RAYS_REFRACTION_MEDIUM_FISH_EYE
// n = index/(1 + r²/size²)
vec4 refraction(vec3 x) {
    float a = 1.0 / (rays_refraction_size * rays_refraction_size), b = 1.0 / (1.0 + a * dot(x, x));
    float square = rays_refraction_index * rays_refraction_index * b * b;
    return vec4((-2.0 * a * b * square) * x, square);
}
#else
// n² = 1 + strength z
vec4 refraction(vec3 x) {
    return vec4(0.0, 0.0, 0.5 * rays_refraction_strength, 1.0 + rays_refraction_strength * x.z);
}
#endif

vec3 field_acceleration(vec3 x, vec3 v) {
    return refraction(x).xyz;
}

#if RAYS_REFRACTION_MEDIUM_EXPLOSION
// Shorter through the shell than along it, and growing with the distance from it: more on the way out, as a step that comes in again has to begin before the shell does.
#define FIELD_LENGTH field_length
float field_length(vec3 x, vec3 v) {
    vec4 shell = from_shell(x);
    float through = rays_refraction_width * dot(shell.xyz, v) / length(v);
    float outwards = clamp(shell.w < 0.0 ? -through : through, -1.0, 1.0);
    return 0.75 * (1.0 + (1.0 + 0.4 * outwards) * max(abs(shell.w) - 0.25, 0.0)) * inversesqrt(0.5 + 0.5 * min(through * through, 2.0));
}
#endif

#define FIELD_SPEED field_speed
float field_speed(vec3 x) {
    return sqrt(max(refraction(x).w, 1e-4));  // where there is no such n, as far below where it is linear, something small
}

#define FIELD_ENERGY field_energy
float field_energy(vec3 x, vec3 v) {
    return 0.5 * (dot(v, v) - refraction(x).w);
}

#include "common/field.glsl"
