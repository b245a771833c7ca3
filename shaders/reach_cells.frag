#version 330 core
// Nodes (reach_nodes.frag) → 1 for each cell between four of them that may show anything of the balls, else 0: its corners end otherwise, or one comes near.
// REACH_FINER: of cells half as wide as those that were found first, and in these alone.
#defines
#include "common/constants.glsl"

uniform sampler2D nodes;
#if REACH_FINER
uniform sampler2D found_first;
#endif

out float near;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy);
    vec4 corners;
    for (int k = 0; k < 4; ++k)
        corners[k] = texelFetch(nodes, first + ivec2(k % 2, k / 2), 0).r;
    bool clear = corners == corners.xxxx && fract(corners.x) == 0.0 && corners.x != float(UNRESOLVED);
#if REACH_FINER
    clear = clear || texelFetch(found_first, first / 2, 0).r == 0.0;
#endif
    near = clear ? 0.0 : 1.0;
}
