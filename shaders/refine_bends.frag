#version 330 core
// Coarse rays that meet things → second differences between the places that they are met at, along x and along y. Without meaning where neighbours meet others.
uniform sampler2D things_met;

layout(location = 0) out vec4 bend_x_out;
layout(location = 1) out vec4 bend_y_out;

void main() {
    ivec2 node = clamp(ivec2(gl_FragCoord.xy), ivec2(1), textureSize(things_met, 0) - 2);
    vec4 twice = 2.0 * texelFetch(things_met, node, 0);
    bend_x_out = texelFetch(things_met, node - ivec2(1, 0), 0) - twice + texelFetch(things_met, node + ivec2(1, 0), 0);
    bend_y_out = texelFetch(things_met, node - ivec2(0, 1), 0) - twice + texelFetch(things_met, node + ivec2(0, 1), 0);
}
