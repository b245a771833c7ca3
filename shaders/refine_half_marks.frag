#version 330 core
// Cells whose pixels are traced by way of rays at every second of them → depth of those rays: 0 where things may be met, 1 where none can, between them where none is
// asked for. A cell takes the rays in it and about it, as differences are taken.
#defines
#include "common/constants.glsl"

uniform sampler2D chosen;  // of the cells: 1 where things may be seen, less where none can, 0 where no such rays are asked for

void main() {
    ivec2 node = ivec2(gl_FragCoord.xy) - HALF_MARGIN, last = textureSize(chosen, 0) - 1;
    ivec2 first = node - 2 >> 1, end = node + 1 >> 1;
    float found = 0.0;
    for (int k = 0; k < 9; ++k)
        found = max(found, texelFetch(chosen, clamp(min(first + ivec2(k % 3, k / 3), end), ivec2(0), last), 0).r);
    gl_FragDepth = found == 0.0 ? 0.5 : found < 1.0 ? 1.0 : 0.0;
}
