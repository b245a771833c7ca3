#version 330 core
// A Gaussian along one axis, to 4σ either way; weights sum to 1.

#blocks

uniform sampler2D source;
uniform ivec2 source_last;   // the last pixel that holds light, which goes on beyond
uniform ivec2 axis;          // (1, 0) or (0, 1)
uniform float sigma;         // pixels

out vec4 colour;

vec3 at(ivec2 place) {
    return texelFetch(source, clamp(place, ivec2(0), source_last), 0).rgb;
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    int reach = int(ceil(4.0 * sigma));
    vec4 sum = vec4(at(place), 1.0);
    for (int k = 1; k <= reach; ++k) {
        float away = float(k) / sigma, weight = exp(-0.5 * away * away);
        sum += weight * vec4(at(place + k * axis) + at(place - k * axis), 2.0);
    }
    colour = vec4(sum.rgb / sum.a, 1.0);
}
