#version 330 core
// What rays of a coarse grid have gone through → depth: which pixels lie between rays with one and the same history (fate, surfaces of media, crossings of the disk's
// plane; where none of these is near the disk it makes no difference how many there are), and the same fate themselves. Between those what media add may be interpolated, and is nothing where none of the four met any; the others are marched by themselves,
// so that no edge has a halo.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"

uniform sampler2D gathered0, dimmed0;  // of the grid; alpha: the pieces of the ray that lie in media, and its history
uniform float spacing;                 // pixels from ray to ray

// What a crossing of the disk's plane adds to a history, and what it adds once where one lies near the disk.
const float ONE_CROSSING = 256.0, NEAR_DISK = 1024.0;

float history(ivec2 ray) {
    return texelFetch(dimmed0, min(ray, textureSize(dimmed0, 0) - 1), 0).a;
}

float pieces(ivec2 ray) {
    return texelFetch(gathered0, min(ray, textureSize(gathered0, 0) - 1), 0).a;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), ray = ivec2((vec2(pixel) + 0.25) / spacing);
    vec4 four = vec4(history(ray), history(ray + ivec2(1, 0)), history(ray + ivec2(0, 1)), history(ray + 1));
    four = mod(four, vec4(all(lessThan(four, vec4(NEAR_DISK))) ? ONE_CROSSING : NEAR_DISK));
    bool alike = four.yzw == four.xxx && int(four.x) % 8 == fetch_escape(pixel).fate;
    bool meets = pieces(ray) + pieces(ray + ivec2(1, 0)) + pieces(ray + ivec2(0, 1)) + pieces(ray + 1) > 0.0;
    gl_FragDepth = !alike ? 0.25 : meets ? 0.75 : 0.5;
}
