#version 330 core
// Cells (reach_cells.frag) → depth of the nodes, by which rays are drawn: below 0.5 for the corners of cells that one ball may fill, and for the nodes about them, as
// differences are taken; and 0 for those of them alone that tell nothing of a cell which may show no ball: by the nodes about its corners, whose differences count too.
#defines
#include "common/constants.glsl"
#include "common/reach_node.glsl"

uniform sampler2D reached;

void main() {
    vec2 texel = 1.0 / vec2(textureSize(reached, 0)), first = (gl_FragCoord.xy - float(GRID_MARGIN) - 3.0) * texel;
    bool fills = false, clear = false;
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) {
            float cell = textureLod(reached, first + vec2(x, y) * texel, 0.0).r;
            bool near = is_near(cell), within = min(x, y) > 0 && max(x, y) < 5;
            clear = clear || cell == REACHED_NONE || near;
            fills = fills || within && cell > REACHED_NONE && cell < REACHED_ANY && !near;
        }
    }
    gl_FragDepth = fills ? (clear ? 0.25 : 0.0) : 1.0;
}
