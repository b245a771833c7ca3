#version 330 core
// A single star over a coarse picture that is shown enlarged → the screen's code of both, where it shines; to be kept where that is brighter than what is there.
#defines
#blocks
#include "common/tone_table.glsl"
#include "common/tone.glsl"
#include "common/developed.glsl"
#slot sky

uniform sampler2D radiance;  // of the coarse picture, filtered linearly
uniform vec2 target_origin;  // lower left pixel of the picture in the target
#if !TURNED
uniform vec2 target_texel;   // 1 / size of the picture in the target
#endif

flat in vec2 place;
flat in vec3 stretch;
flat in vec3 brightest;
flat in vec3 glowing;
#if TURNED
flat in vec2 map_place;
flat in vec4 map_steps;
#endif

out vec4 colour;

void main() {
    vec2 pixel = gl_FragCoord.xy - target_origin, d = pixel - place;
    float fall = sky_kernel(stretch.x * d.x * d.x + 2.0 * stretch.y * d.x * d.y + stretch.z * d.y * d.y);
#if TURNED
    vec2 behind = map_place + d.x * map_steps.xy + d.y * map_steps.zw;
#else
    vec2 behind = pixel * target_texel;
#endif
    vec3 light = textureLod(radiance, behind, 0.0).rgb + glowing + fall * brightest;
    colour = fall > 0.0 ? vec4(developed(light), 1.0) : vec4(0.0);
}
