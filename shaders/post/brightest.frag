#version 330 core
// The largest luminance of 8 × 8 pixels of the source, in all channels alike: drawn again and again, of a whole picture.
#include "common/luminance.glsl"

uniform sampler2D source;
uniform ivec2 source_last;   // the last pixel

out vec4 colour;

const int SIDE = 8;

void main() {
    ivec2 first = SIDE * ivec2(gl_FragCoord.xy);
    float most = 0.0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) most = max(most, luminance(texelFetch(source, min(first + ivec2(x, y), source_last), 0).rgb));
    colour = vec4(vec3(most), 1.0);
}
