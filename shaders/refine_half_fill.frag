#version 330 core
// What the pixels between rays at every second one meet, or where they lead, where refine_half_cells.frag says that it is interpolated: a hit map's texels, as the trace
// pass would leave them. Cubics along x and y: halfway between two nodes they are the mean, less an eighth of what the mean of those about is more.
// Or polynomials through three or six (common/half_ways.glsl).
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_write.glsl"
#include "common/row_error.glsl"
#include "common/half_ways.glsl"

uniform sampler2D half_cells;  // as that leaves them
uniform sampler2D half_ends;   // of the rays: where they end and on what (refine_half_ends.frag), without things their hits, as traced; all are filtered linearly
#if MEETINGS
uniform sampler2D half0, half_way;  // hits, as traced
#endif

// Means of the two nodes in a row about those that `place` is halfway between, whose mean is given.
vec3 mean_about(vec2 place, vec2 onward, vec3 mean, int way) {
#if MEETINGS
    // Of three in a row the fourth is where their quadratic has it.
    float side = way == WITHOUT_FIRST ? 1.0 : -1.0;
    bool all = way == BY_FOUR;
    vec3 one = textureLod(half_ends, place - (all ? 1.5 : 0.5 * side) * onward, 0.0).xyz, other = textureLod(half_ends, place + (all ? 1.5 : 1.5 * side) * onward, 0.0).xyz;
    return all ? 0.5 * (one + other) : 3.0 * (one - mean) + other;
#else
    return 0.5 * (textureLod(half_ends, place - 1.5 * onward, 0.0).xyz + textureLod(half_ends, place + 1.5 * onward, 0.0).xyz);
#endif
}

vec3 mean_outermost(vec2 place, vec2 onward) {
    return 0.5 * (textureLod(half_ends, place - 2.5 * onward, 0.0).xyz + textureLod(half_ends, place + 2.5 * onward, 0.0).xyz);
}

vec3 interpolated(vec2 place, vec2 between, int way) {
    vec2 texel = 1.0 / vec2(textureSize(half_ends, 0)), right = vec2(texel.x, 0.0), up = vec2(0.0, texel.y);
    bool by_six = way == BY_SIX;
    vec3 mean = textureLod(half_ends, place, 0.0).xyz;
    vec3 about_x = mean_about(place, right, mean, by_six ? BY_FOUR : way % 3), about_y = mean_about(place, up, mean, by_six ? BY_FOUR : way / 3);
    vec3 cubic = mean - 0.125 * (between.x * (about_x - mean) + between.y * (about_y - mean));
    vec3 more_x = beyond_cubic(mean, about_x, mean_outermost(place, right)), more_y = beyond_cubic(mean, about_y, mean_outermost(place, up));
    return by_six ? cubic + between.x * more_x + between.y * more_y : cubic;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), node = pixel / 2 + HALF_MARGIN;
    vec2 place = (0.5 * vec2(pixel) + float(HALF_MARGIN) + 0.5) / vec2(textureSize(half_ends, 0)), between = vec2(pixel & 1);
    int way = way_of_cell(texelFetch(half_cells, pixel / 2, 0).r);
#if MEETINGS
    vec4 traced = textureLod(half0, (vec2(node) + 0.5) / vec2(textureSize(half0, 0)), 0.0);
#else
    vec4 traced = texelFetch(half_ends, node, 0);
#endif
    vec3 end = interpolated(place, between, way);
    Hits hits = no_hits(0.0);
    hits.fate = texel_fate(traced);
    hits.steps = int(texel_steps(traced));
    if (hits.fate == ESCAPED) hits.direction = normalize(end);
#if MEETINGS
    float what = max(texelFetch(half_ends, node, 0).w, 0.0);
    hits.meeting[0] = unpacked_meeting(vec4(end, what), textureLod(half_way, place, 0.0), traced.xyz AND_TIME(0.0));
#endif
    store_hits(hits);
}
