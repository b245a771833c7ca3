// Straight rays and a black ball in flat space.

#include "common/disk_plane.glsl"

// Hits of the straight ray that starts as `start`, with a ball of `radius` in r_s.
// The ray is b + t v with b at right angles to the unit vector v; written so that a camera at infinity needs no case of its own.
Hits straight_hits(RayStart start, float radius) {
    Hits hits = no_hits(start.lambda);
    hits.steps = 1;
    float bend = length(start.n_rate);                          // impact parameter in M
    vec3 across = bend > 0.0 ? start.n_rate / bend : vec3(0.0);
    float cosine = start.w_rate, sine = start.w * bend;
    vec3 v = sine * across - cosine * start.n;
    vec3 b = 0.5 * bend * (sine * start.n + cosine * across);
    float t_start = camera_w > 0.0 ? -0.5 * cosine / start.w : -1e30;
    float inside = (radius - 0.5 * bend) * (radius + 0.5 * bend);
    float t_end = inside > 0.0 && cosine > 0.0 ? -sqrt(inside) : 1e30;
    hits.fate = t_end < 1e30 ? CAPTURED : ESCAPED;
    if (hits.fate == ESCAPED) hits.direction = normalize(v);
    float t = 0.0;
    vec2 point = vec2(0.0);
    bool crosses = false;
#if ORDERS > 0
    vec3 from_disk = in_disk_axes(b), along = in_disk_axes(v);
    t = -from_disk.z / along.z;
    point = from_disk.xy + t * along.xy;
    crosses = disk_height(start.n) != 0.0 && along.z != 0.0 && t > t_start && t < t_end;
    crosses = crosses && dot(point, point) > crossing_r_min * crossing_r_min;
#if !MEETINGS
    if (crosses) add_crossing(hits, point, momentum_at(disk_place(point), v));
#endif
#endif
#if MEETINGS
    float from = max(t_start, -2.0 * (meeting_reach + 0.5 * bend) - (crosses ? abs(t) : 0.0));
    if (meet_on_line(b + from * v, v, t_end - from, crosses ? t - from : -1.0, point, hits)) {
        hits.fate = MET;
        hits.direction = vec3(0.0);
    }
#endif
    return hits;
}
