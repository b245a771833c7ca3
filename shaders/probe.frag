#version 330 core
// The g-factors of a hit map's crossings, by the very function that shades the disk; for `trace`, tests and charts.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_orbit.glsl"

out vec4 g_out;  // exact E_infinity/E_emitter of crossings 0, 1, 2; 0 = none

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    float g[3];
    for (int n = 0; n < 3; ++n) {
        float r = length(hits.crossing[n]);
        g[n] = r > 0.0 ? disk_g(r, hits.lambda) : 0.0;
    }
    g_out = vec4(g[0], g[1], g[2], 1.0);
}
