#version 330 core
// What the pixels of cells meet that one thing fills (refine_things.frag), interpolated between coarse rays: a hit map's texels, as the trace pass would leave them.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_write.glsl"

uniform sampler2D things_met, things_way; // these are filtered linearly
uniform sampler2D bend_x, bend_y;         // second differences of places

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = (vec2(pixel) / float(REFINE_STEP) + float(GRID_MARGIN) + 0.5) / vec2(textureSize(things_met, 0));
    vec2 s = vec2(pixel & (REFINE_STEP - 1)) * (1.0 / float(REFINE_STEP)), weight = 0.5 * s * (s - 1.0);
    vec4 met = textureLod(things_met, place, 0.0);  // what is met is the same at all four nodes
    met.xyz += weight.x * textureLod(bend_x, place, 0.0).xyz + weight.y * textureLod(bend_y, place, 0.0).xyz;
    Hits hits = no_hits(0.0);
    hits.fate = MET;
    hits.meeting[0] = unpacked_meeting(met, textureLod(things_way, place, 0.0), vec3(0.0) AND_TIME(0.0));
    store_hits(hits);
}
