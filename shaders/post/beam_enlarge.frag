#version 330 core
// A smooth picture enlarged along one axis by the cubic B-spline, which widens it by a third of a pixel's square: the Gaussian before it is narrower by as much.

uniform sampler2D source;
uniform ivec2 source_last;   // the last pixel that holds light, which goes on beyond
uniform ivec2 axis;          // (1, 0) or (0, 1)
uniform float factor;        // by how much it is enlarged
uniform float margin;        // pixels of the source that stand before its first one

out vec4 colour;

void main() {
    float place = dot(gl_FragCoord.xy, vec2(axis)) / factor + margin - 0.5, before = floor(place), t = place - before, s = 1.0 - t;
    vec4 weights = vec4(s * s * s, 4.0 - 3.0 * t * t * (1.0 + s), 4.0 - 3.0 * s * s * (1.0 + t), t * t * t) / 6.0;
    ivec2 across = ivec2(gl_FragCoord.xy) * (1 - axis);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) sum += weights[k] * texelFetch(source, clamp(across + (int(before) + k - 1) * axis, ivec2(0), source_last), 0).rgb;
    colour = vec4(sum, 1.0);
}
