#version 330 core
// Relative drift, at the end of the march, of what a ray's model conserves (RAY_DRIFT, common/march.glsl).
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/false_colour.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float drift = fetch_drift(pixel);
    vec3 colour = drift < 0.0 ? view_legend[0] : false_colour(drift);
    radiance = vec4(fetch_hits(pixel).fate == UNRESOLVED ? view_legend[1] : colour, 1.0);
}
