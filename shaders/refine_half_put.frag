#version 330 core
// Rays at every second pixel, and those of the pixels between them that are not interpolated, which lie side by side in a map of their own (rendering/packed_rays.py) → the
// texels of a hit map, as they are.
#defines
#include "common/constants.glsl"

uniform sampler2D numbers;                       // of the cells of 2×2 pixels, as packed_rays.py has them
uniform sampler2D half0, half_met, half_way;     // of the rays at every second pixel
uniform sampler2D packed0, packed_met, packed_way;

layout(location = 0) out vec4 hits0_out;
layout(location = 1) out vec4 met0_out;
layout(location = 2) out vec4 way0_out;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), cell = pixel / 2, node = cell + HALF_MARGIN;
    int first = int(texelFetch(numbers, cell, 0).r), part = (pixel.x & 1) + 2 * (pixel.y & 1);
    bool is_node = first < 0 && part == 0;
    int number = first < 0 ? part - 2 - first : first + part, across = textureSize(packed0, 0).x / 4;
    ivec2 texel = 4 * ivec2((number >> 4) % across, (number >> 4) / across) + ivec2(number & 3, number >> 2 & 3);
    texel = is_node ? ivec2(0) : texel;
    hits0_out = is_node ? texelFetch(half0, node, 0) : texelFetch(packed0, texel, 0);
    met0_out = is_node ? texelFetch(half_met, node, 0) : texelFetch(packed_met, texel, 0);
    way0_out = is_node ? texelFetch(half_way, node, 0) : texelFetch(packed_way, texel, 0);
}
