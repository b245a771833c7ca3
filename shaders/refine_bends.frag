#version 330 core
// Coarse rays that meet things → second differences between the places that they are met at, along x and along y: about each node, or where one of its two neighbours
// meets something else, about the other; 0 where that cannot be, either.
uniform sampler2D things_met;

layout(location = 0) out vec4 bend_x_out;
layout(location = 1) out vec4 bend_y_out;

vec4 bend_along(ivec2 node, ivec2 step) {
    vec4 here = texelFetch(things_met, node, 0), last = texelFetch(things_met, node - step, 0), next = texelFetch(things_met, node + step, 0);
    vec4 before = texelFetch(things_met, node - 2 * step, 0), after = texelFetch(things_met, node + 2 * step, 0);
    bool is_last = last.w == here.w, is_next = next.w == here.w;
    if (is_last && is_next) return last - 2.0 * here + next;
    if (is_next && after.w == here.w) return here - 2.0 * next + after;
    if (is_last && before.w == here.w) return here - 2.0 * last + before;
    return vec4(0.0);
}

void main() {
    ivec2 node = clamp(ivec2(gl_FragCoord.xy), ivec2(2), textureSize(things_met, 0) - 3);
    bend_x_out = bend_along(node, ivec2(1, 0));
    bend_y_out = bend_along(node, ivec2(0, 1));
}
