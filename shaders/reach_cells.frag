#version 330 core
// Nodes (reach_nodes.frag) → 1 for each cell between four of them that may show anything of the balls, else 0.
//
// A cell is clear where its corners end alike, and none of them comes so near a ball that a ray one step beside it, as far apart in the end as those about the
// cell are from their neighbours, would meet it.
#defines
#include "common/constants.glsl"

uniform sampler2D nodes;

out float near;

int fate_of(vec4 node) {
    return int(node.w);
}

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy); // of the 4 × 4 nodes in and around the cell
    vec4 node[16];
    for (int k = 0; k < 16; ++k)
        node[k] = texelFetch(nodes, first + ivec2(k % 4, k / 4), 0);
    int fate = fate_of(node[5]);
    bool alike = fate != UNRESOLVED;
    float apart = 0.0, needed = 4.0;
    for (int k = 0; k < 4; ++k) {
        int corner = 5 + (k % 2) + 4 * (k / 2);
        alike = alike && fate_of(node[corner]) == fate;
        needed = min(needed, 4.0 * fract(node[corner].w));
        for (int side = 0; side < 4; ++side) {
            vec4 beside = node[corner + (side < 2 ? 2 * side - 1 : 8 * side - 20)];
            apart = max(apart, fate_of(beside) == fate ? distance(beside.xyz, node[corner].xyz) : 0.0);
        }
    }
    near = alike && needed > apart ? 0.0 : 1.0;
}
