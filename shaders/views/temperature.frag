#version 330 core
// Temperature of the light from the first crossing that meets the disk, as it colours the picture: g·T, but for shifts that are switched off.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#include "common/disk_orbit.glsl"
#include "common/disk_temperature.glsl"
#include "common/false_colour.glsl"

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    vec3 colour = view_legend[0];
#if ORDERS > 0
    DiskLight light = disk_light(hits.lambda, pixel_direction(gl_FragCoord.xy));
    for (int n = ORDERS - 1; n >= 0; --n) {
        float r = clamp(length(hits.crossing[n]), disk_r_edge, disk_r_out);
        DiskLight sent = light_at_crossing(light, hits.crossing[n], is_inbound(hits, n));
        vec2 shift = disk_colour_shift(disk_shift(r, sent, is_inbound(hits, n)), light.energy.x);
        if (on_disk(hits.crossing[n])) colour = false_colour(disk_temperature_k * disk_temperature(r) * shift.x * shift.y);
    }
#endif
    radiance = vec4(colour, 1.0);
}
