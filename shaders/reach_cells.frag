#version 330 core
// Nodes (reach_nodes.frag, reach_field.frag) → for each cell between four of them REACHED_NONE; the share n/255 where the ball n − 1 alone can be seen, as it hides the
// rest from all of them; REACHED_ANY where any may be seen: its corners end otherwise, or several may come between them; REACHED_NEAR where none may, but some are near.
// And which balls may be the first that is met there, a bit each.
// REACH_FINER: of cells half as wide as those that were found first, and in these alone.
#defines
#blocks
#include "common/constants.glsl"
#include "common/reach_node.glsl"

uniform usampler2D nodes;
uniform ivec2 reach_first; // texel of the first
uniform int reach_count; // balls
#if REACH_FINER
uniform sampler2D found_first;
uniform usampler2D balls_first;
#endif

layout(location = 0) out float near;
layout(location = 1) out uint balls;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy);
    uvec2 corner = texelFetch(nodes, reach_first + first, 0).rg;
    uint holds = node_reached(corner).holds, near_any = 0u, between = 0u;
    bool alike = true, hides = holds > 0u;
    for (int k = 0; k < 4; ++k) {
        uvec2 node = texelFetch(nodes, reach_first + first + ivec2(k % 2, k / 2), 0).rg;
        Reached reached = node_reached(node);
        near_any |= reached.near;
        between |= reached.between;
        alike = alike && node_fate(node) == node_fate(corner);
        hides = hides && reached.holds == holds;
    }
    bool clear = alike && between == 0u && node_fate(corner) != UNRESOLVED;
    hides = hides && between == 1u << (holds - 1u);
    balls = alike && node_fate(corner) != UNRESOLVED ? near_any : (1u << reach_count) - 1u;
    near = clear ? (near_any == 0u ? REACHED_NONE : REACHED_NEAR) : hides ? float(holds) / 255.0 : REACHED_ANY;
#if REACH_FINER
    float before = texelFetch(found_first, first / 2, 0).r;
    if (before < REACHED_ANY) balls = texelFetch(balls_first, first / 2, 0).r;
    near = before < REACHED_ANY ? before : near;
#endif
}
