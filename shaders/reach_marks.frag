#version 330 core
// Cells (reach_cells.frag) → depth of nodes half as far apart: 0 for those that are corners of cells which are near, and for all of their quads, as each takes
// differences from the others (common/reach.glsl); else 1.
uniform sampler2D found_first;

void main() {
    ivec2 quad = ivec2(gl_FragCoord.xy) / 2, last = textureSize(found_first, 0) - 1;
    float near = 0.0;
    for (int k = 0; k < 4; ++k)
        near = max(near, texelFetch(found_first, clamp(quad - ivec2(k % 2, k / 2), ivec2(0), last), 0).r);
    gl_FragDepth = near > 0.0 ? 0.0 : 1.0;
}
