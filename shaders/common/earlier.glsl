// Where what moves was when the light that is seen left it (rays.light_travel): the parameters of an instance's motion are those of `seen_delay` before scene time.
// Orbits are circles about the hole (blackhole_gl/physics/motion.py); what turns about itself has turned less.
#include "common/rotation.glsl"

#if RAYS_LIGHT_TRAVEL
float seen_delay = 0.0;  // r_s/c

// v where it was on the circle of what is at `bound` and has `velocity`, whose w is how fast it goes round, rad per r_s/c.
vec3 earlier_on_circle(vec3 v, vec3 bound, vec4 velocity) {
    vec3 axis = cross(bound, velocity.xyz);
    float size = length(axis);
    if (size < 1e-12) return v;
    axis /= size;
    vec2 turn = cos_sin(-abs(velocity.w) * seen_delay);
    return turn.x * v + turn.y * cross(axis, v) + (1.0 - turn.x) * dot(axis, v) * axis;
}

vec4 earlier_bound(vec4 bound, vec4 velocity) {
    return vec4(earlier_on_circle(bound.xyz, bound.xyz, velocity), bound.w);
}

vec4 earlier_velocity(vec4 bound, vec4 velocity) {
    return vec4(earlier_on_circle(velocity.xyz, bound.xyz, velocity), velocity.w);
}

// The unit quaternion `attitude` before it had turned on by `spin`, rad per r_s/c.
vec4 earlier_attitude(vec4 attitude, vec4 spin) {
    float rate = length(spin.xyz);
    if (rate == 0.0) return attitude;
    vec2 turn = cos_sin(-0.5 * rate * seen_delay);
    vec3 part = spin.xyz * (turn.y / rate);
    return vec4(turn.x * attitude.xyz + attitude.w * part + cross(part, attitude.xyz), turn.x * attitude.w - dot(part, attitude.xyz));
}
#endif
