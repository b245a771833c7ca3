// The light of a pixel where it leaves the disk: its constants, and its radial momentum by them.
#include "common/observer.glsl"

struct DiskLight {
    float lambda;  // L_z/E in M
    float eta;     // Q/E² in M²
    float energy;  // E_observer/E_infinity
};

// Q/E² of the light that arrives from the local direction `local`.
float carter_constant(vec3 local) {
    vec4 start = observer_map * vec4(1.0, local);
    vec2 rates = start.zw / start.x;
    return rates.x * rates.x + camera_n.z * camera_n.z * (rates.y * rates.y - hole_spin * hole_spin);
}

DiskLight disk_light(float lambda, vec3 local) {
    return DiskLight(lambda, carter_constant(local), 1.0 / max(pixel_energy_ratio(local), 1e-6));
}

// −w'/|E| in Mino time, M = 1, of the light at r (r_s): Δ k_r/r², above 0 outwards. Its square is the radial potential in w = M/r.
float outward_rate(DiskLight light, float r, bool inbound) {
    float w = 0.5 / r, a = hole_spin, turn = light.lambda - a;
    float square = 1.0 + w * w * (a * a - light.lambda * light.lambda - light.eta + w * (2.0 * (turn * turn + light.eta) - w * a * a * light.eta));
    return inbound ? -sqrt(max(square, 0.0)) : sqrt(max(square, 0.0));
}
