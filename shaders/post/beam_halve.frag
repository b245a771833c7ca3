#version 330 core
// A picture at half its size along one axis, by the binomial weights 1 5 10 10 5 1: a plain mean would let what is finer than a pixel shift what is left.

#blocks

uniform sampler2D source;
uniform ivec2 source_last;   // the last pixel that holds light, which goes on beyond
uniform ivec2 axis;          // (1, 0) or (0, 1)
uniform int margin;          // pixels of the source that stand before its first one

out vec4 colour;

vec3 at(ivec2 place) {
    return texelFetch(source, clamp(place, ivec2(0), source_last), 0).rgb;
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy) * (1 + axis) - margin * axis; // the left, or lower, of the two in the middle
    vec3 sum = 10.0 * (at(place) + at(place + axis)) + 5.0 * (at(place - axis) + at(place + 2 * axis)) + at(place - 2 * axis) + at(place + 3 * axis);
    colour = vec4(sum / 32.0, 1.0);
}
