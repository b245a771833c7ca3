#version 330 core
// Hit map → depth: what a pixel will need, so that the depth test can keep the disk's and the sky's shaders from pixels that
// do not need them. (A branch would not: docs/llvmpipe.md.)
//
// PIXEL_MATTER, PIXEL_SKY, PIXEL_NEITHER, PIXEL_SOLID_THING or PIXEL_THING, in this order of depth: all that may cross the disk are nearer than one depth, all that
// may be of the sky nearer than another, one draw each, and those that show a thing or a medium farther than a third, with those that may be of the sky, too,
// farther than a fourth. The few that cross the disk and are not of the sky are black in it.
//
// And marks by which edges are found, as that takes the same texels.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#if IN_FIELD
#include "common/observer.glsl"
#endif
#include "common/edge_marks.glsl"
#include "common/orders_shown.glsl"

out vec2 mark;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Hits stored = stored_hits(pixel), hits = shown_orders(stored);
    mark = edge_mark(stored, pixel);
    bool disk = false;
#if ORDERS > 0
    for (int n = 0; n < ORDERS; ++n)
        disk = may_be_covered(crossing_of(hits.crossing[n], hits.fate)) || disk;
#endif
    bool thing = false;
#if MEETINGS
    thing = hits.meeting[0].kind >= 0;
#endif
    gl_FragDepth = class_depth(thing ? (hits.fate == MET ? PIXEL_SOLID_THING : PIXEL_THING) : disk ? PIXEL_MATTER : hits.fate == ESCAPED ? PIXEL_SKY : PIXEL_NEITHER);
}
