#version 330 core
// Hit map → depth: what a pixel will need, so that the depth test can keep the disk's and the sky's shaders from pixels that
// do not need them. (A branch would not: llvmpipe runs both sides of every branch for every pixel.)
//
//   0.2  captured or unresolved, may cross the disk   0.6  escaped, no disk
//   0.4  escaped, may cross the disk                  0.8  captured or unresolved, no disk
//
// So disk is below 0.5 and sky below 0.7: one draw each. The few of 0.2 have no sky, and are black in it.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"

void main() {
    Hits hits = stored_hits(ivec2(gl_FragCoord.xy));
    bool disk = false;
#if ORDERS > 0
    for (int n = 0; n < ORDERS; ++n)
        disk = may_be_covered(crossing_of(hits.crossing[n])) || disk;
#endif
    gl_FragDepth = hits.fate == ESCAPED ? (disk ? 0.4 : 0.6) : (disk ? 0.2 : 0.8);
}
