#version 330 core
// A refined hit map as its readers see it, pixel by pixel, in the layout of the trace pass (common/hit_map_write.glsl): for the host.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/hit_map_write.glsl"

void main() {
    store_hits(stored_hits(ivec2(gl_FragCoord.xy)));
}
