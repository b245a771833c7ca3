/*---
label = "Weak field"
summary = "Two straight lines with one kink at closest approach, 2 r_s/b or to second order in r_s/b: good far from the hole, where it costs next to nothing."
source = "Einstein 1915; second order: Keeton & Petters 2005"
slot = "ray_model"
rank = 10
kind = "closed"
space_time = "schwarzschild"
spins = false
exact = false
tilted_disk = true

[parameters.second_order]
default = true
help = "Adds 15π r_s²/(16 b²) to the deflection 2 r_s/b."
---*/
// A ray that starts at the angle ψ from the hole bends by (1 + cos ψ)/2 of the whole on its way: to first order exact for a static
// observer at any distance, all of it from afar and none looking straight away.

#include "common/disk_plane.glsl"

Hits trace_ray(RayStart start) {
    Hits hits = no_hits(start.lambda);
    hits.steps = 1;
    float bend = length(start.n_rate);
    vec3 across = bend > 0.0 ? start.n_rate / bend : vec3(0.0);
    float u = 1.0 / max(0.5 * bend, 1e-6);  // r_s/b
    float cosine = start.w_rate, lapse = sqrt(1.0 - 2.0 * start.w);
    float sine = start.w * bend * lapse;
    bool inside_photon_sphere = start.w * 3.0 > 1.0;
    bool below_critical = u * 2.59807621 > 1.0;
    if (inside_photon_sphere ? cosine > 0.0 || !below_critical : cosine > 0.0 && below_critical) hits.fate = CAPTURED;
    else hits.fate = ESCAPED;

    vec3 v = sine * across - cosine * start.n;
    vec3 outward = sine * start.n + cosine * across;  // from the hole to the closest approach
    vec3 closest = (0.5 * bend * lapse) * outward;
    float t_start = camera_w > 0.0 ? -0.5 * cosine / start.w : -1e30;
    float t_kink = max(t_start, 0.0);                 // past the closest approach: at once
    float angle = u;
#if RAYS_WEAK_FIELD_SECOND_ORDER
    angle += 1.47262156 * u * u;
#endif
    float share = cosine > 0.0 ? 1.0 + cosine : sine * sine / (1.0 - cosine);  // 1 + cos ψ without cancellation
    vec2 kink = cos_sin(min(share * angle, 100.0));
    vec3 leaving = kink.x * v - kink.y * outward;
    if (hits.fate == ESCAPED) hits.direction = normalize(leaving);
#if ORDERS > 0
    float least = crossing_r_min * crossing_r_min;
    vec3 from_disk = in_disk_axes(closest), along = in_disk_axes(v);
    vec2 point = from_disk.xy - (from_disk.z / along.z) * along.xy;
    float t = -from_disk.z / along.z;
    if (disk_height(start.n) != 0.0 && t > t_start && t < 0.0 && dot(point, point) > least) add_crossing(hits, point, momentum_at(disk_place(point), v));
    vec3 corner = in_disk_axes(closest + t_kink * v), onward = in_disk_axes(leaving);
    t = -corner.z / onward.z;
    point = corner.xy + t * onward.xy;
    bool from_within = disk_height(start.n) == 0.0 && cosine <= 0.0;  // a straight line that starts in the plane meets it nowhere else
    if (hits.fate == ESCAPED && t > 0.0 && !from_within && dot(point, point) > least) add_crossing(hits, point, momentum_at(disk_place(point), leaving));
#endif
    return hits;
}
