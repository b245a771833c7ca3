#version 330 core
// Steps that each ray took, on a logarithmic scale up to the most it may take.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/false_colour.glsl"

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    radiance = vec4(hits.fate == UNRESOLVED ? view_legend[0] : false_colour(float(hits.steps)), 1.0);
}
