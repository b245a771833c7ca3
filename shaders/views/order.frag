#version 330 core
// Which crossings a ray has: a colour each, full where it meets the disk, dim where it meets the disk's plane beside it.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#include "common/false_colour.glsl"

const float BESIDE = 0.12;  // how bright a crossing beside the disk is

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    vec3 sum = vec3(0.0);
#if ORDERS > 0
    for (int n = 0; n < ORDERS; ++n)
        if (hits.crossing[n] != vec2(0.0)) sum += view_legend[n] * (on_disk(hits.crossing[n]) ? 1.0 : BESIDE);
#endif
    radiance = vec4(sum == vec3(0.0) ? view_legend[3] : min(sum, 1.0), 1.0);
}
