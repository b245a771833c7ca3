/*---
label = "Sphere"
summary = "A sphere, at rest or on its way round the hole: a moon, a star, or, about the origin and larger than the hole, a neutron star."
source = "Weiskopf, Schafhitzel & Ertl 2004"
slot = "thing"
rank = 1
moves = true
round = true
surface = true
meets = "crossing"
reach = ["radius"]

[parameters.radius]
default = 1.0
range = [0.001, 100.0]
unit = "r_s"
help = "Its radius."

---*/
#include "common/rotation.glsl"
#include "common/colour.glsl"
#include "common/surface.glsl"
#include "common/sphere.glsl"

float thing_sphere_crossing(int i, vec3 x, vec3 y, out bool enters) {
    vec4 bound = thing_sphere_bound(i);
    return sphere_crossing(bound.xyz, bound.w, x, y, enters);
}

// Longitude and latitude at `arm` from the centre, in its own axes, and their changes: no angle is taken of a difference, so that there is no seam.
Painted globe_place(vec3 arm, vec3 right, vec3 up) {
    const float ROUND = 6.28318531;
    float beside2 = max(dot(arm.xy, arm.xy), 1e-12 * dot(arm, arm)), beside = sqrt(beside2), whole2 = beside2 + arm.z * arm.z;
    vec2 at = vec2(turns(arm.x, arm.y), 0.5 + 2.0 * turns(beside, arm.z));
    vec2 change = vec2(arm.x * right.y - arm.y * right.x, 0.0) / (ROUND * beside2);
    change.y = 2.0 * (beside * right.z - arm.z * dot(arm.xy, right.xy) / beside) / (ROUND * whole2);
    vec2 other = vec2(arm.x * up.y - arm.y * up.x, 0.0) / (ROUND * beside2);
    other.y = 2.0 * (beside * up.z - arm.z * dot(arm.xy, up.xy) / beside) / (ROUND * whole2);
    return Painted(at, change, other);
}

Light thing_sphere_light(int i, Sight sight) {
    vec4 bound = thing_sphere_bound(i), attitude = thing_sphere_attitude(i);
    vec3 arm = sight.place - bound.xyz;
    Painted spot = globe_place(unturned(attitude, arm), unturned(attitude, sight.right), unturned(attitude, sight.up));
    vec3 velocity = thing_sphere_velocity(i).xyz + cross(thing_sphere_spin(i).xyz, arm);
    return Light(surface_radiance(thing_sphere_finish(i), spot, sight, arm / bound.w, velocity), vec3(0.0));
}
