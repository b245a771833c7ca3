#version 330 core
// Hit map → depth: what a pixel will need, so that the depth test can keep the disk's and the sky's shaders from pixels that
// do not need them. (A branch would not: llvmpipe runs both sides of every branch for every pixel.)
//
//   0.15  may cross the disk, and may be of the sky     0.25  of the sky, no disk     0.5  neither
//   0.95  as 0.15, but what may be on the disk is the first crossing alone: such pixels need less
//
// So disk is below 0.2 and above 0.8, sky below 0.3 and above 0.8. The few that cross the disk and are not of the sky are black in it.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"

void main() {
    Hits hits = stored_hits(ivec2(gl_FragCoord.xy));
    bool first = false, later = false;
#if ORDERS > 0
    first = may_be_covered(crossing_of(hits.crossing[0]));
    for (int n = 1; n < ORDERS; ++n)
        later = may_be_covered(crossing_of(hits.crossing[n])) || later;
#endif
    float without_later = first ? (ORDERS > 1 ? 0.95 : 0.15) : hits.fate == ESCAPED ? 0.25 : 0.5;
    gl_FragDepth = later ? 0.15 : without_later;
}
