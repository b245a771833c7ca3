#version 330 core
// Marks of pixels → 1 where what a pixel shows changes within it or beside it, so that one ray is too few (blackhole_gl/render/edges.py); else 0.
//
// A ring may be thinner than a pixel and met by no pixel's middle; but it lies beside the line across which the fate changes, or the order.
// The direct picture's own edges are left out: its cover is smooth.
#defines
#include "common/edge_marks.glsl"

uniform sampler2D marks;  // common/edge_marks.glsl

out float edge;

ivec2 mark_at(ivec2 pixel) {
    return ivec2(255.0 * textureLod(marks, (vec2(pixel) + 0.5) / vec2(textureSize(marks, 0)), 0.0).xy + 0.5);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), here = mark_at(pixel);
    // Through a veil only what ends at the first ring's edges does not count.
    ivec2 counts = ivec2((here.x & VEILED) != 0 ? ~(VEILED | RING_1 * 3) : ~VEILED, ~0);
    bool found = (here.x & RING_2) != 0;  // the second ring is thin everywhere
    for (int k = 0; k < 9; ++k) {
        ivec2 beside = mark_at(pixel + ivec2(k % 3, k / 3) - 1);
        found = found || beside.x != NO_RAY && ((beside ^ here) & counts) != ivec2(0);
    }
    edge = here.x != NO_RAY && found ? 1.0 : 0.0;
}
