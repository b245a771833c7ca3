#version 330 core
// Hit map → what of each pixel's ray is alike on all sides where nothing ends, for edge_pixels.frag. Pixels without a ray of their own keep what is cleared to.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#include "common/edge_marks.glsl"

uniform bool disk_hides; // whether the direct picture hides the first ring's edges well enough

out vec2 mark;

// Where a crossing lies: 0 outside the disk's outer edge, or nowhere, 1 on the disk, 2 inside its inner edge. Between 0 and 2 lies a disk too thin to be met.
int zone(vec2 point) {
    return on_disk(point) ? 1 : point != vec2(0.0) && dot(point, point) < disk_r_in * disk_r_in ? 2 : 0;
}

void main() {
    Hits hits = stored_hits(ivec2(gl_FragCoord.xy));
    int seen = hits.fate;
#if ORDERS > 1
    seen |= zone(hits.crossing[1]) * RING_1 | zone(hits.crossing[2]) * RING_2;
#endif
#if ORDERS > 0 && DISK_COMPOSITING_OPACITY
    seen |= disk_hides && on_disk(hits.crossing[0]) ? VEILED : 0;
#endif
    int met = 0;
#if MEETINGS
    for (int k = 0; k < MEETINGS; ++k)
        met = (met * 31 + hits.meeting[k].kind + 1) & 127;
#endif
    mark = vec2(seen, met) / 255.0;
}
