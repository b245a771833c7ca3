#version 330 core
// Cells → depth: what a pixel of a refined map will need, as shade_classes.frag says it of an exact one. A cell's pixels share one class,
// which may be wider than a pixel needs; a pixel with a ray of its own may need anything:
//
//   0.1  a ray of its own: trace.frag is still to draw it, and the depth test keeps it from all others
//   0.2  captured, may cross the disk     0.6  escaped, no disk
//   0.4  escaped, may cross the disk      0.8  captured, no disk
#defines
#blocks
#include "common/constants.glsl"
#include "common/hit_cells.glsl"

uniform usampler2D cells;

void main() {
    uint cell = texelFetch(cells, ivec2(gl_FragCoord.xy) / REFINE_STEP, 0).r;
    bool disk = cell_sees_disk(cell);
    float shared_class = cell_fate(cell) == ESCAPED ? (disk ? 0.4 : 0.6) : (disk ? 0.2 : 0.8);
    gl_FragDepth = cell_has_own_rays(cell) ? 0.1 : shared_class;
}
