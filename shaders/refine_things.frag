#version 330 core
// Coarse rays that meet things → 1 for each cell whose pixels one ball fills and may be interpolated between, else 0: it hides all else from the rays at the corners
// (reach_cells.frag), the rays at the corners and in each row one beside them meet it, with no crossing of the disk's plane before it, and what interpolation leaves out (as
// in refine_nodes.frag) displaces what is seen by less than refine_px.
#defines
#include "common/constants.glsl"
#include "common/row_error.glsl"

#blocks

uniform sampler2D things_met;   // of the nodes: place, and what is met there
uniform sampler2D reached;      // of the cells
uniform sampler2D reach_balls;  // common/reach.glsl
uniform float refine_px;

out float solid;

// Kind and index of what is met from without, as reach_balls has them; −1 where the disk's plane is crossed before.
int thing_of(float met) {
    int bits = int(met + 0.5);
    return (bits >> 5 & 7) == 4 ? (bits & 31) + 32 * (bits >> 8) : -1;
}

// The same where one of the four meets something else, and the second differences of the other three are all that there is: of a root, which is how places go at an
// outline, a quadratic through three places leaves out as much.
const float OF_THREE = 1.0 / 8.0;

// A row of four nodes, the cell between the middle two: whether these meet `thing`, and one of the others at least; and the error of interpolation between them.
bool row_of(ivec2 first, ivec2 step, int thing, out vec3 slope, out vec3 error) {
    vec3 places[4];
    bool alike[4];
    for (int k = 0; k < 4; ++k) {
        vec4 node = texelFetch(things_met, first + k * step, 0);
        places[k] = node.xyz;
        alike[k] = thing_of(node.w) == thing;
    }
    error = row_error(places);
    if (!alike[0]) error = OF_THREE * (places[3] - 2.0 * places[2] + places[1]);
    if (!alike[3]) error = OF_THREE * (places[2] - 2.0 * places[1] + places[0]);
    slope = (places[2] - places[1]) / float(REFINE_STEP);
    return alike[1] && alike[2] && (alike[0] || alike[3]);
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
    vec3 right = 0.5 * (slope[0] + slope[1]), up = 0.5 * (slope[2] + slope[3]);
    float moved = 0.0;
    for (int k = 0; k < 2; ++k)
        moved = max(moved, displacement(right, up, error[k], error[2 + k]));
    solid = alike && moved < refine_px ? 1.0 : 0.0;
}
