#version 330 core
// g = E_observer/E_emitter of the first crossing that meets the disk, by the formula that shades it.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#include "common/disk_orbit.glsl"
#include "common/false_colour.glsl"

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    vec3 colour = view_legend[0];
#if ORDERS > 0
    DiskLight light = disk_light(hits.lambda, pixel_direction(gl_FragCoord.xy));
    for (int n = ORDERS - 1; n >= 0; --n) {
        DiskLight sent = light_at_crossing(light, hits.crossing[n], is_inbound(hits, n));
        vec2 shift = disk_shift(clamp(length(hits.crossing[n]), disk_r_edge, disk_r_out), sent, is_inbound(hits, n));
        if (on_disk(hits.crossing[n])) colour = false_colour(shift.x * shift.y * light.energy.x);
    }
#endif
    radiance = vec4(colour, 1.0);
}
