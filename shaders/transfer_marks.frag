#version 330 core
// What rays of a coarse grid have gone through → depth: which pixels lie between rays with one and the same history (fate, surfaces of media, crossings of the disk's
// plane), and the same fate themselves. Between those what media add may be interpolated; the others are marched by themselves, so that no edge has a halo.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"

uniform sampler2D passed0;  // of the grid; alpha: the history
uniform float spacing;      // pixels from ray to ray

float history(ivec2 ray) {
    return texelFetch(passed0, min(ray, textureSize(passed0, 0) - 1), 0).a;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), ray = ivec2((vec2(pixel) + 0.25) / spacing);
    float first = history(ray);
    bool alike = history(ray + ivec2(1, 0)) == first && history(ray + ivec2(0, 1)) == first && history(ray + 1) == first;
    alike = alike && int(first) % 8 == fetch_escape(pixel).fate;
    gl_FragDepth = alike ? 0.75 : 0.25;
}
