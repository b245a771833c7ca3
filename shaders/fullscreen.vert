#version 330 core
// One triangle that covers the picture; needs no buffers. Takes the host's numbers along for the fragment shader (blackhole_gl/glsl/carried.py).
#blocks

uniform float triangle_depth = 0.0; // normalised device depth: what a depth test against a prepared buffer compares

void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, triangle_depth, 1.0);
    carry();
}
