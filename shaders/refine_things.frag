#version 330 core
// Coarse rays that meet things → 1 for each cell whose pixels one ball fills and may be interpolated between, else 0: it hides all else from the rays at the corners
// (reach_cells.frag), the rays at and around the corners all meet it, with no crossing of the disk's plane before it, and what interpolation leaves out (as in
// refine_nodes.frag) displaces what is seen by less than refine_px.
#defines
#include "common/constants.glsl"

#blocks

uniform sampler2D things_met;   // of the nodes: place, and what is met there
uniform sampler2D reached;      // of the cells
uniform sampler2D reach_balls;  // common/reach.glsl
uniform float refine_px;

out float solid;

// Shares of the differences that stand for the error, as in refine_nodes.frag.
const float OF_THIRD = 1.0 / 32.0, OF_FOURTH = 1.0 / 48.0, OF_SECOND = 1.0 / 256.0;

// Kind and index of what is met, as reach_balls has them; −1 where the disk's plane is crossed before.
int thing_of(float met) {
    int bits = int(met + 0.5);
    return (bits >> 5 & 3) == 0 ? (bits & 31) + 32 * (bits >> 8) : -1;
}

// A row of four nodes, the cell between the middle two: whether all meet `thing`, and the error of interpolation between them.
bool row_of(ivec2 first, ivec2 step, int thing, out vec3 slope, out vec3 error) {
    vec4 node[4];
    bool alike = true;
    for (int k = 0; k < 4; ++k) {
        node[k] = texelFetch(things_met, first + k * step, 0);
        alike = alike && thing_of(node[k].w) == thing;
    }
    vec3 before = node[2].xyz - 2.0 * node[1].xyz + node[0].xyz, after = node[3].xyz - 2.0 * node[2].xyz + node[1].xyz;
    vec3 third = after - before, second = dot(before, before) > dot(after, after) ? before : after;
    error = (OF_THIRD + OF_FOURTH * length(third) / max(length(second), 1e-12)) * third + OF_SECOND * second;
    slope = (node[2].xyz - node[1].xyz) / float(REFINE_STEP);
    return alike;
}

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy), cell = corner - GRID_MARGIN;
    bool is_cell = cell == clamp(cell, ivec2(0), textureSize(reached, 0) - 1);
    int ball = is_cell ? int(255.0 * texelFetch(reached, cell, 0).r + 0.5) - 1 : -1;
    int thing = ball >= 0 && ball < 24 ? int(texelFetch(reach_balls, ivec2(ball, 1), 0).x + 0.5) : 0;
    bool alike = thing > 0;
    vec3 slope[4], error[4];
    for (int k = 0; k < 2; ++k) {
        alike = row_of(corner + ivec2(-1, k), ivec2(1, 0), thing, slope[k], error[k]) && alike;
        alike = row_of(corner + ivec2(k, -1), ivec2(0, 1), thing, slope[2 + k], error[2 + k]) && alike;
    }
    // How far in pixels what is seen moves for an error in space: what of it lies along the surface.
    vec3 right = 0.5 * (slope[0] + slope[1]), up = 0.5 * (slope[2] + slope[3]);
    float xx = dot(right, right), xy = dot(right, up), yy = dot(up, up), inverse = 1.0 / max(xx * yy - xy * xy, 1e-30);
    float moved = 0.0;
    for (int k = 0; k < 2; ++k) {
        vec2 worst = vec2(0.0);
        for (int axis = 0; axis < 2; ++axis) {
            vec2 along = vec2(dot(right, error[2 * axis + k]), dot(up, error[2 * axis + k]));
            worst += abs(inverse * vec2(yy * along.x - xy * along.y, xx * along.y - xy * along.x));
        }
        moved = max(moved, length(worst));
    }
    solid = alike && moved < refine_px ? 1.0 : 0.0;
}
