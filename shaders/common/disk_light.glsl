// The light of a pixel where it leaves the disk: its constants, and its momentum by them.
#include "common/observer.glsl"
#include "common/disk_plane.glsl"

struct DiskLight {
    float lambda;  // L_z/E in M; with DISK_TILTED, at a crossing: about the disk's axis
    float eta;     // Q/E² in M²; with DISK_TILTED, at a crossing: k_n²/E², k_n its momentum along the disk's axis times r
    vec2 energy;   // E_observer/E_infinity, for colours and for brightness
#if DISK_TILTED
    vec2 heading;  // unit vector from the hole to the crossing, in the disk's axes
#endif
};

// Q/E² of the light that arrives from the local direction `local`.
float carter_constant(vec3 local) {
    vec4 start = observer_map * vec4(1.0, local);
    vec2 rates = start.zw / start.x;
    return rates.x * rates.x + camera_n.z * camera_n.z * (rates.y * rates.y - hole_spin * hole_spin);
}

DiskLight disk_light(float lambda, vec3 local) {
#if DISK_TILTED
    return DiskLight(lambda, carter_constant(local), pixel_energies(local), vec2(1.0, 0.0));
#else
    return DiskLight(lambda, carter_constant(local), pixel_energies(local));
#endif
}

// The light at a crossing in `point`. In z = 0 its constants tell all; elsewhere k_θ² = η + a² cos² θ − λ² cot² θ, and `southward` its sign (Hits.inbound).
DiskLight light_at_crossing(DiskLight light, vec2 point, bool southward) {
#if DISK_TILTED
    vec2 heading = point == vec2(0.0) ? vec2(1.0, 0.0) : normalize(point);
    vec3 n = disk_place(heading);
#if SPACE_TIME_FLAT
    float level = camera_n.z;  // straight rays keep k_θ² + λ² cot² θ
#else
    float level = n.z;
#endif
    float sine = max(length(n.xy), 1e-5), cot = n.z / sine, a = hole_spin;
    float size = sqrt(max(light.eta + a * a * level * level - light.lambda * light.lambda * cot * cot, 0.0));
    vec3 e_phi = vec3(-n.y, n.x, 0.0) / sine, e_theta = cross(e_phi, n);
    vec3 momentum = (light.lambda / sine) * e_phi + (southward ? size : -size) * e_theta;
    float normal = disk_height(momentum);
    return DiskLight(dot(momentum, disk_place(vec2(-heading.y, heading.x))), normal * normal, light.energy, heading);
#else
    return light;
#endif
}

// −w'/|E| in Mino time, M = 1, of the light at r (r_s): Δ k_r/r², above 0 outwards. Its square is the radial potential in w = M/r.
float outward_rate(DiskLight light, float r, bool inbound) {
    float w = 0.5 / r, a = hole_spin, turn = light.lambda - a;
    float square = 1.0 + w * w * (a * a - light.lambda * light.lambda - light.eta + w * (2.0 * (turn * turn + light.eta) - w * a * a * light.eta));
    return inbound ? -sqrt(max(square, 0.0)) : sqrt(max(square, 0.0));
}
