// Light in a spherical field, (dr/dσ)² = E² − h²u²(1 − G u) + 2 G M u with u = 1/r (r_s = 1): the parts of an orbit that run
// between far radii, in closed form. They make the escape direction independent of where a march stopped. M is the model's
// ray_newtonian_pull(), 0 where light is light.

#include "common/disk_plane.glsl"

const int LEG_NODES = 6;
const float LEG_X[6] = float[6](0.033765243, 0.169395307, 0.380690407, 0.619309593, 0.830604693, 0.966234757);
const float LEG_W[6] = float[6](0.085662246, 0.180380787, 0.233956967, 0.233956967, 0.180380787, 0.085662246);

// A ray counts as outward bound when its radial cosine is above this. The six-point Gauss–Legendre sum is then good to 2e-8:
// the integrand's nearest singularity, the turning point, lies 1.67 intervals away.
const float OUTWARD_COSINE = 0.8;

struct Orbit {
    float h2;  // |x × v|², constant
    float e2;  // E²: 1 where G = 1; else what the observer's frame of G = 1 makes it
};

// |dr/dσ| at u = 1/r, on a part without a turning point.
float radial_speed(Orbit orbit, float u) {
    return sqrt(orbit.e2 - orbit.h2 * u * u * (1.0 - hole_gravity_strength * u) + 2.0 * hole_gravity_strength * ray_newtonian_pull() * u);
}

// A monotonic leg between u0 and u1: (angle swept, ∫ u³ dσ).
vec2 orbit_leg(Orbit orbit, float u0, float u1) {
    vec2 sum = vec2(0.0);
    for (int i = 0; i < LEG_NODES; ++i) {
        float u = mix(u0, u1, LEG_X[i]);
        sum += vec2(sqrt(orbit.h2), u) * (LEG_W[i] / radial_speed(orbit, u));
    }
    return abs(u1 - u0) * sum;
}

// The unit vector `n` turned by `angle` towards `across`, a unit vector at right angles to it.
vec3 turned(vec3 n, vec3 across, float angle) {
    vec2 turn = cos_sin(angle);
    return turn.x * n + turn.y * across;
}

// Where the outward leg from (n, u0) to u_end that moves towards `across` meets the disk's plane, as (point in the plane, ∫ u³ dσ up to it, 1), and the unit
// vector `onward` that it moves towards there; vec4(0) when it does not. Newton in u, as dφ/du is known.
vec4 leg_crossing(Orbit orbit, vec3 n, vec3 across, float u0, float u_end, out vec3 onward) {
    onward = vec3(0.0);
    vec2 whole = orbit_leg(orbit, u0, u_end);
    if (disk_height(n) * disk_height(turned(n, across, whole.x)) >= 0.0) return vec4(0.0);
    float u = 0.5 * (u0 + u_end);
    vec2 leg;
    vec3 there;
    for (int i = 0; i < 8; ++i) {
        leg = orbit_leg(orbit, u0, u);
        there = turned(n, across, leg.x);
        float slope = disk_height(turned(across, -n, leg.x)) * sqrt(orbit.h2) / radial_speed(orbit, u);
        u = clamp(u + disk_height(there) / slope, max(1e-3 * u, u_end), u0);
    }
    onward = turned(across, -n, leg.x);
    return vec4(normalize(in_disk_axes(there).xy) / u, leg.y, 1.0);
}
