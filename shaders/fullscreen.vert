#version 330 core
// One triangle that covers the picture, which needs no buffers; or squares of it, as points. Takes the host's numbers along for the fragment shader
// (blackhole_gl/glsl/carried.py).
#blocks

in vec3 square; // where the middle of a square is, in normalised device coordinates, and its side in pixels; 0 where no buffer holds any: the triangle

uniform float triangle_depth = 0.0; // normalised device depth: what a depth test against a prepared buffer compares

void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(square.z > 0.0 ? square.xy : corner * 2.0 - 1.0, triangle_depth, 1.0);
    gl_PointSize = square.z;
    carry();
}
