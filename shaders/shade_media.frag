#version 330 core
// What the media on a ray add to its light, and as a second colour what they let through of what lies behind: where no disk is seen.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_texels.glsl"
#include "common/hit_map_read.glsl"
#include "common/matter.glsl"
#include "common/stretches.glsl"

layout(location = 0, index = 0) out vec4 radiance;
layout(location = 0, index = 1) out vec4 passed;

const float BRIGHTEST = 6.0e4;  // what a half float holds

void main() {
    Light light = stretch_light(ivec2(gl_FragCoord.xy), 0);
    for (int n = 1; n <= ORDERS; ++n) light = behind(light, stretch_light(ivec2(gl_FragCoord.xy), n));
    radiance = vec4(clamp(light.gathered, 0.0, BRIGHTEST), light.passed.x);
    passed = vec4(light.passed, 1.0);
}
