#version 330 core
// Rays at every second pixel → where each ends and on what, in one texel: what tells pixels between them apart, and what interpolates these, reads a dozen of them and more.
#defines
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_texels.glsl"

uniform sampler2D half0, half_met; // hits, as traced; the nearest: docs/llvmpipe.md, texels

out vec4 end_out; // the place in r_s and what is met there, as a hit map has them; or the direction, and less than that its fate

void main() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(half0, 0));
    vec4 escape = textureLod(half0, place, 0.0), met = textureLod(half_met, place, 0.0);
    end_out = met.w > 0.0 ? met : vec4(escape.xyz, -float(texel_fate(escape)));
}
