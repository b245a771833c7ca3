#version 330 core
// Cells → depth, so that the depth test lets the trace pass run only where pixels need rays of their own:
// 0.25 there, 0.75 where the hits of the coarse grid will be interpolated.
#defines
#include "common/hit_cells.glsl"

uniform usampler2D cells;

void main() {
    uint cell = texelFetch(cells, ivec2(gl_FragCoord.xy) / REFINE_STEP, 0).r;
    gl_FragDepth = cell_has_own_rays(cell) ? 0.25 : 0.75;
}
