#version 330 core
// A smooth picture enlarged along one axis by the cubic B-spline, which widens it by a third of a pixel's square: the Gaussian before it is narrower by as much.

#blocks

uniform sampler2D source;
uniform ivec2 axis;          // (1, 0) or (0, 1)
uniform float factor;        // by how much it is enlarged
uniform float margin;        // pixels of the source that stand before its first one

out vec4 colour;

void main() {
    float place = dot(gl_FragCoord.xy, vec2(axis)) / factor + margin - 0.5, before = floor(place), t = place - before, s = 1.0 - t;
    vec4 weights = vec4(s * s * s, 4.0 - 3.0 * t * t * (1.0 + s), 4.0 - 3.0 * s * s * (1.0 + t), t * t * t) / 6.0;
    ivec2 first = ivec2(gl_FragCoord.xy) * (1 - axis) + (int(before) - 1) * axis; // its margin holds all that is read
    vec3 sum = weights.x * texelFetch(source, first, 0).rgb + weights.y * texelFetch(source, first + axis, 0).rgb
             + weights.z * texelFetch(source, first + 2 * axis, 0).rgb + weights.w * texelFetch(source, first + 3 * axis, 0).rgb;
    colour = vec4(sum, 1.0);
}
