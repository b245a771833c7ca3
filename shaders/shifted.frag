#version 330 core
// A texture moved by whole pixels: what is known of directions, for a grid that begins elsewhere (blackhole_gl/rendering/known_light.py).
#blocks

uniform sampler2D source;
uniform vec2 shift;  // from a pixel of the target to that of the source

out vec4 texel;

void main() {
    texel = texelFetch(source, ivec2(gl_FragCoord.xy + shift), 0);
}
