#version 330 core
// Cells (reach_cells.frag) → depth of the nodes: 0 for the corners of those that one ball may fill, and for the nodes about them, as differences are taken; else 1.
#defines
#include "common/constants.glsl"
#include "common/reach_node.glsl"

uniform sampler2D reached;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) - GRID_MARGIN - 2, last = textureSize(reached, 0) - 1;
    bool fills = false;
    for (int k = 0; k < 16; ++k) {
        float cell = texelFetch(reached, clamp(first + ivec2(k % 4, k / 4), ivec2(0), last), 0).r;
        fills = fills || cell > REACHED_NONE && cell < REACHED_ANY && !is_near(cell);
    }
    gl_FragDepth = fills ? 0.0 : 1.0;
}
