#version 330 core
// Classes of the cells → depth: what a pixel of a refined map will need. A cell's pixels share one class, which may be wider than a pixel needs.
// PIXEL_OWN_RAY and PIXEL_THING: trace.frag is still to draw it, and the depth test keeps it from all others. PIXEL_FLAT_SKY: read with HIT_MAP_REFINED = 2.
#defines
#blocks
#include "common/constants.glsl"

uniform sampler2D cell_classes; // eight bits, the nearest: docs/llvmpipe.md, texels
uniform vec2 pixels_to_cells;   // 1/(REFINE_STEP·cells)
uniform float all_traced;       // 1 where every pixel now has a ray of its own, whatever its cell is like; else 0

void main() {
    float found = textureLod(cell_classes, gl_FragCoord.xy * pixels_to_cells, 0.0).r;
    bool is_thing = found > class_depth(PIXEL_SOLID_THING) - 0.05;
    gl_FragDepth = all_traced == 0.0 ? found : is_thing ? class_depth(PIXEL_THING) : min(found, 1.0 - found);
}
