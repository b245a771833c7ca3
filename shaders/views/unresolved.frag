#version 330 core
// Rays that ended nowhere, over a dim picture of what became of the others.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#include "common/false_colour.glsl"

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    bool disk = false;
#if ORDERS > 0
    for (int n = 0; n < ORDERS; ++n)
        disk = disk || on_disk(hits.crossing[n]);
#endif
    vec3 fate = disk ? view_legend[3] : hits.fate == ESCAPED ? view_legend[1] : view_legend[2];
    radiance = vec4(hits.fate == UNRESOLVED ? view_legend[0] : fate, 1.0);
}
