#version 330 core
// Rays at every second pixel, and those of the pixels between them that are not interpolated, which lie side by side in a map of their own (rendering/packed_rays.py) → the
// texels of a hit map, as they are.
#defines
#include "common/constants.glsl"

uniform sampler2D numbers;                       // of the cells of 2×2 pixels, as packed_rays.py has them
// All but half_way, which is filtered, give the nearest texel: docs/llvmpipe.md, texels.
uniform sampler2D half0, half_met, half_way;     // of the rays at every second pixel
uniform sampler2D packed0, packed_met, packed_way;

layout(location = 0) out vec4 hits0_out;
layout(location = 1) out vec4 met0_out;
layout(location = 2) out vec4 way0_out;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), cell = pixel / 2, node = cell + HALF_MARGIN;
    int first = int(texelFetch(numbers, cell, 0).r), part = (pixel.x & 1) + 2 * (pixel.y & 1);
    bool is_node = first < 0 && part == 0;
    int number = first < 0 ? part - 2 - first : first + part;
    float block = float(number >> 4), across = 0.25 * float(textureSize(packed0, 0).x), row = floor((block + 0.5) / across);  // whole numbers are divided one by one
    vec2 texel = (vec2(4.0 * (block - across * row), 4.0 * row) + vec2(number & 3, number >> 2 & 3) + 0.5) / vec2(textureSize(packed0, 0));
    vec2 traced = (vec2(node) + 0.5) / vec2(textureSize(half0, 0));
    hits0_out = textureLod(packed0, texel, 0.0);
    met0_out = textureLod(packed_met, texel, 0.0);
    way0_out = textureLod(packed_way, texel, 0.0);
    vec4 hits = textureLod(half0, traced, 0.0), met = textureLod(half_met, traced, 0.0), way = texelFetch(half_way, node, 0);
    if (is_node) {
        hits0_out = hits;
        met0_out = met;
        way0_out = way;
    }
}
