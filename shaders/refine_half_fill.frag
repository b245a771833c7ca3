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
uniform sampler2D half0;       // of the rays: hits, as traced; all are filtered linearly
#if MEETINGS
uniform sampler2D half_met, half_way;
#endif

// Means of the two nodes in a row about those that `place` is halfway between, whose mean is given.
vec3 mean_about(sampler2D nodes, vec2 place, vec2 onward, vec3 mean, int way) {
#if MEETINGS
    // Of three in a row the fourth is where their quadratic has it.
    float side = way == WITHOUT_FIRST ? 1.0 : -1.0;
    bool all = way == BY_FOUR;
    vec3 one = textureLod(nodes, place - (all ? 1.5 : 0.5 * side) * onward, 0.0).xyz, other = textureLod(nodes, place + (all ? 1.5 : 1.5 * side) * onward, 0.0).xyz;
    return all ? 0.5 * (one + other) : 3.0 * (one - mean) + other;
#else
    return 0.5 * (textureLod(nodes, place - 1.5 * onward, 0.0).xyz + textureLod(nodes, place + 1.5 * onward, 0.0).xyz);
#endif
}

vec3 mean_outermost(sampler2D nodes, vec2 place, vec2 onward) {
    return 0.5 * (textureLod(nodes, place - 2.5 * onward, 0.0).xyz + textureLod(nodes, place + 2.5 * onward, 0.0).xyz);
}

// `six`: directions alone are ever interpolated by six.
vec3 interpolated(sampler2D nodes, vec2 place, vec2 between, int way, const bool six) {
    vec2 texel = 1.0 / vec2(textureSize(nodes, 0)), right = vec2(texel.x, 0.0), up = vec2(0.0, texel.y);
    bool by_six = six && way == BY_SIX;
    vec3 mean = textureLod(nodes, place, 0.0).xyz;
    vec3 about_x = mean_about(nodes, place, right, mean, by_six ? BY_FOUR : way % 3), about_y = mean_about(nodes, place, up, mean, by_six ? BY_FOUR : way / 3);
    vec3 cubic = mean - 0.125 * (between.x * (about_x - mean) + between.y * (about_y - mean));
    if (!six) return cubic;
    vec3 more_x = beyond_cubic(mean, about_x, mean_outermost(nodes, place, right)), more_y = beyond_cubic(mean, about_y, mean_outermost(nodes, place, up));
    return by_six ? cubic + between.x * more_x + between.y * more_y : cubic;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), node = pixel / 2 + HALF_MARGIN;
    vec2 place = (0.5 * vec2(pixel) + float(HALF_MARGIN) + 0.5) / vec2(textureSize(half0, 0)), between = vec2(pixel & 1);
    int way = way_of_cell(texelFetch(half_cells, pixel / 2, 0).r);
    vec4 escape = texelFetch(half0, node, 0);
    Hits hits = no_hits(0.0);
    hits.fate = texel_fate(escape);
    hits.steps = int(texel_steps(escape));
    if (hits.fate == ESCAPED) hits.direction = normalize(interpolated(half0, place, between, way, true));
#if MEETINGS
    float met = texelFetch(half_met, node, 0).w;
    hits.meeting[0] = unpacked_meeting(vec4(interpolated(half_met, place, between, way, false), met), textureLod(half_way, place, 0.0), escape.xyz AND_TIME(0.0));
#endif
    store_hits(hits);
}
