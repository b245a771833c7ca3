#version 330 core
// Classes of the cells → depth: what a pixel of a refined map will need. A cell's pixels share one class, which may be wider than a pixel needs.
//
//   0.05  a ray of its own: trace.frag is still to draw it, and the depth test keeps it from all others; it may need anything
//   0.15, 0.25, 0.5  as in shade_classes.frag
//   0.75             as 0.25, and flat: directions may be interpolated linearly, and nothing else is read (HIT_MAP_REFINED = 2)
#defines
#blocks

uniform sampler2D cell_classes; // eight bits, the nearest: software renderers fetch that in two thirds of the time of texelFetch
uniform vec2 pixels_to_cells;   // 1/(REFINE_STEP·cells)
uniform float all_traced;       // 1 where every pixel now has a ray of its own, whatever its cell is like; else 0

void main() {
    float found = textureLod(cell_classes, gl_FragCoord.xy * pixels_to_cells, 0.0).r;
    gl_FragDepth = all_traced > 0.0 ? min(found, 1.0 - found) : found;
}
