#version 330 core
// Nodes (reach_nodes.frag, reach_field.frag) → for each cell between four of them REACHED_NONE; the share n/255 where the ball n − 1 alone can be seen, as it hides the
// rest from all of them; REACHED_ANY where any may be seen: its corners end otherwise, or come near several.
// And which balls may be the first that is met there, a bit each.
// REACH_FINER: of cells half as wide as those that were found first, and in these alone.
#defines
#blocks
#include "common/constants.glsl"
#include "common/reach_node.glsl"

uniform usampler2D nodes;
uniform int reach_count; // balls
#if REACH_FINER
uniform sampler2D found_first;
uniform usampler2D balls_first;
#endif

layout(location = 0) out float near;
layout(location = 1) out uint balls;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy);
    uint corner = texelFetch(nodes, first, 0).r, hidden = node_reached(corner).hidden, any = 0u;
    bool alike = true, hides = hidden > 0u;
    for (int k = 0; k < 4; ++k) {
        uint node = texelFetch(nodes, first + ivec2(k % 2, k / 2), 0).r;
        Reached reached = node_reached(node);
        any |= reached.near;
        alike = alike && node_fate(node) == node_fate(corner);
        hides = hides && reached.hidden == hidden;
    }
    bool clear = alike && any == 0u && node_fate(corner) != UNRESOLVED;
    hides = hides && any == 1u << (hidden - 1u);
    balls = alike && node_fate(corner) != UNRESOLVED ? any : (1u << reach_count) - 1u;
    near = clear ? REACHED_NONE : hides ? float(hidden) / 255.0 : REACHED_ANY;
#if REACH_FINER
    float before = texelFetch(found_first, first / 2, 0).r;
    if (before < REACHED_ANY) balls = texelFetch(balls_first, first / 2, 0).r;
    near = before < REACHED_ANY ? before : near;
#endif
}
