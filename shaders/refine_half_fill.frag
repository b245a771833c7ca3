#version 330 core
// What the pixels between rays at every second one meet, or where they lead, where refine_half_cells.frag says that it is interpolated: a hit map's texels, as the trace
// pass would leave them. Cubics along x and y: halfway between two nodes they are the mean, less an eighth of what the mean of those beyond is more.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_write.glsl"

uniform sampler2D half0;  // of the rays: hits, as traced; all are filtered linearly
#if MEETINGS
uniform sampler2D half_met, half_way;
#endif

vec3 interpolated(sampler2D nodes, vec2 place, vec2 between) {
    vec2 texel = 1.0 / vec2(textureSize(nodes, 0)), right = vec2(1.5 * texel.x, 0.0), up = vec2(0.0, 1.5 * texel.y);
    vec3 mean = textureLod(nodes, place, 0.0).xyz;
    vec3 beyond_x = 0.5 * (textureLod(nodes, place - right, 0.0).xyz + textureLod(nodes, place + right, 0.0).xyz);
    vec3 beyond_y = 0.5 * (textureLod(nodes, place - up, 0.0).xyz + textureLod(nodes, place + up, 0.0).xyz);
    return mean - 0.125 * (between.x * (beyond_x - mean) + between.y * (beyond_y - mean));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), node = pixel / 2 + HALF_MARGIN;
    vec2 place = (0.5 * vec2(pixel) + float(HALF_MARGIN) + 0.5) / vec2(textureSize(half0, 0)), between = vec2(pixel & 1);
    vec4 escape = texelFetch(half0, node, 0);
    Hits hits = no_hits(0.0);
    hits.fate = texel_fate(escape);
    hits.steps = int(texel_steps(escape));
    if (hits.fate == ESCAPED) hits.direction = normalize(interpolated(half0, place, between));
#if MEETINGS
    float met = texelFetch(half_met, node, 0).w;
    hits.meeting[0] = unpacked_meeting(vec4(interpolated(half_met, place, between), met), textureLod(half_way, place, 0.0) AND_TIME(0.0));
#endif
    store_hits(hits);
}
