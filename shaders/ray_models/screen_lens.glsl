/*---
label = "Screen lens"
summary = "The flat picture displaced about the hole's place on the screen, and a black disc on it: the cheapest, a thin lens for what lies far behind the hole, wrong for the disk."
source = "a screen-space lens effect (docs/sources.md)"
slot = "ray_model"
rank = 11
kind = "closed"
tells_paths = true
space_time = "flat"
spins = false
exact = false
tilted_disk = true

[parameters.radius]
default = 1.0
range = [0.0, 10.0]
unit = "r_s"
help = "Rad in offset ×= 1 − 2 Rad/(ρ √D)², with ρ on a screen at distance 1; at 1 the sky is displaced as by a thin lens of this mass."
physical = 1.0
[parameters.shadow]
default = 2.598
range = [0.0, 10.0]
unit = "r_s"
help = "Radius of the black disc, as the impact parameter of the rays that it hides; light is captured below 2.598 r_s."
physical = 2.598
---*/
#include "common/straight.glsl"

// For a camera at infinity the displacement is infinitely long at the disk but a finite angle at the sky.
Hits far_hits(RayStart start, float b) {
    Hits hits = no_hits(start.lambda);
    hits.steps = 1;
    hits.fate = ESCAPED;
    hits.direction = normalize(-start.n - (rays_screen_lens_radius / (b * b)) * start.n_rate);
    return hits;
}

Hits trace_ray(RayStart start) {
    float b = 0.5 * length(start.n_rate);
    bool ahead = start.w_rate > 0.0;
    if (ahead && b < rays_screen_lens_shadow) {
        Hits hits = no_hits(start.lambda);
        hits.steps = 1;
        hits.fate = CAPTURED;
        return hits;
    }
    if (camera_w == 0.0) return far_hits(start, b);
    if (ahead && b > 0.0) {
        vec3 place = start.n_rate * (start.w / start.w_rate);  // on a screen at distance 1
        place *= 1.0 - 4.0 * rays_screen_lens_radius * start.w / dot(place, place);
        start.w_rate = inversesqrt(1.0 + dot(place, place));
        start.n_rate = place * (start.w_rate / start.w);
        start.lambda = -dot(start.n_rate, camera_e_phi.xyz) * camera_n.w;  // of the ray whose light is shown
    }
    return straight_hits(start, 0.0);
}
