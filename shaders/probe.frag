#version 330 core
// The g-factors of listed rays' crossings, by the very function that shades the disk; for `trace`, tests and charts.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_orbit.glsl"

uniform sampler2D listed_rays;

out vec4 g_out;  // exact E_infinity/E_emitter of crossings 0, 1, 2; 0 = none

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    DiskLight light = disk_light(hits.lambda, texelFetch(listed_rays, ivec2(gl_FragCoord.xy), 0).xyz);
    float g[3];
    for (int n = 0; n < 3; ++n) {
        float r = length(hits.crossing[n]);
        g[n] = r > 0.0 ? disk_g(r, light_at_crossing(light, hits.crossing[n], is_inbound(hits, n)), is_inbound(hits, n)) : 0.0;
    }
    g_out = vec4(g[0], g[1], g[2], 1.0);
}
