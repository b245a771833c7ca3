#version 330 core
// Cells of a coarse grid of rays (transfer_cells.frag) → depth: which pixels lie between rays with one and the same history, and have their fate themselves. Between those what media add may be
// interpolated, and is nothing where none of the four met any; the others are marched by themselves, so that no edge has a halo.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"

uniform sampler2D media_cells;
uniform vec2 pixel_to_cell;  // from a pixel's column and row to the place of its cell, in both directions

const float SEEN = 8.0;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float cell = textureLod(media_cells, (vec2(pixel) + 0.25) * pixel_to_cell, 0.0).r, fate = float(fetch_escape(pixel).fate);
    gl_FragDepth = cell == fate ? 0.5 : cell == fate + SEEN ? 0.75 : 0.25;
}
