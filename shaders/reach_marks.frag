#version 330 core
// Cells (reach_cells.frag) → depth of nodes half as far apart: 0 for those that are corners of cells which may show any ball, and for all of their quads, as each takes
// differences from the others (common/reach.glsl); else 1.
#defines
#include "common/constants.glsl"
#include "common/reach_node.glsl"

uniform sampler2D found_first;

void main() {
    ivec2 quad = ivec2(gl_FragCoord.xy) / 2, last = textureSize(found_first, 0) - 1;
    float near = 0.0;
    for (int k = 0; k < 4; ++k)
        near = max(near, texelFetch(found_first, clamp(quad - ivec2(k % 2, k / 2), ivec2(0), last), 0).r);
    gl_FragDepth = near < REACHED_ANY ? 1.0 : 0.0;
}
