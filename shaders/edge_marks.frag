#version 330 core
// Hit map → marks of the pixels with rays of their own, where not all have one; all others keep what is cleared to. (Of a sharp map: shade_classes.frag.)
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

out vec2 mark;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    mark = edge_mark(stored_hits(pixel), pixel);
}
