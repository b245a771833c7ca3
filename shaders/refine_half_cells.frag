#version 330 core
// Rays at every second pixel → for each 2×2 pixels the class of what is still to be done: PIXEL_MATTER where they are interpolated between these rays, that of their own
// rays where they are not, PIXEL_NEITHER where nothing is.
//
// Interpolated is where the rays at the corners and those around meet the same or go the same way, and where what is left out (common/row_error.glsl) displaces what is
// seen by less than refine_px, or light's direction by less than the angle of as many pixels: where a field crowds much of the sky into a pixel, the former.
#defines
#include "common/constants.glsl"

#blocks
#include "common/hits.glsl"
#include "common/hit_texels.glsl"
#include "common/row_error.glsl"

uniform sampler2D chosen;        // refine_half_marks.frag
uniform sampler2D cell_classes;
uniform sampler2D half0;         // of the rays: hits, as traced
uniform vec2 refine_tolerance;   // refine_nodes.frag
uniform float refine_px;
#if MEETINGS
uniform sampler2D half_met;
uniform usampler2D cell_balls;   // reach_cells.frag
uniform uint narrow_balls;       // those that may be seen narrower than the rays are apart
#endif

out float class_out;

// What a ray ends on, more than 0, or its fate, negative; 0 of a ray that ends nowhere. And where: a place, or a direction.
int end_of(ivec2 node, out vec3 place) {
    vec4 escape = texelFetch(half0, node, 0);
#if MEETINGS
    vec4 met = texelFetch(half_met, node, 0);
    place = met.w > 0.0 ? met.xyz : escape.xyz;
    return met.w > 0.0 ? int(met.w + 0.5) : -texel_fate(escape);
#else
    place = escape.xyz;
    return -texel_fate(escape);
#endif
}

vec3 shorter(vec3 a, vec3 b) {
    return dot(a, a) < dot(b, b) ? a : b;
}

// A row of four nodes, the cell between the middle two: whether all end on `what`, and the error of interpolation between them. Where one part of a thing hides another,
// places jump within the cell, and change little beside it: the least slope counts.
bool row_of(ivec2 first, ivec2 step, int what, out vec3 slope, out vec3 error) {
    vec3 places[4];
    bool alike = true;
    for (int k = 0; k < 4; ++k)
        alike = end_of(first + k * step, places[k]) == what && alike;
    error = row_error(places);
    slope = places[2] - places[1];
    if (what > 0) slope = shorter(slope, shorter(places[1] - places[0], places[3] - places[2]));
    slope *= 0.5;
    return alike;
}

// How far from its surface a place on a thing may be, r_s: of those that tell_apart, which are looked for again near the place when they are shaded, no farther than
// half a pixel is wide.
float room_beside(int what, vec3 place) {
    float room = 1e30;
#if MEETINGS
    float pixel = 0.5 * refine_tolerance.y / refine_px * distance(place, camera_n.xyz * (0.5 / camera_w));
#each thing_told_apart : if (what > 0 && (what & 31) == THING_$KEY + 1) room = pixel;
#endif
    return room;
}

void main() {
    ivec2 pixels = ivec2(gl_FragCoord.xy), cell = pixels / 2, corner = pixels + HALF_MARGIN;
    vec3 start, slope[4], error[4];
    int what = end_of(corner, start);
    bool alike = what != 0;
    for (int k = 0; k < 2; ++k) {
        alike = row_of(corner + ivec2(-1, k), ivec2(1, 0), what, slope[k], error[k]) && alike;
        alike = row_of(corner + ivec2(k, -1), ivec2(0, 1), what, slope[2 + k], error[2 + k]) && alike;
    }
    vec3 right = 0.5 * (slope[0] + slope[1]), up = 0.5 * (slope[2] + slope[3]);
    float moved = 0.0, turned = 0.0;
    for (int k = 0; k < 2; ++k) {
        moved = max(moved, displacement(right, up, error[k], error[2 + k]));
        turned = max(turned, length(error[k]) + length(error[2 + k]));
    }
    bool near = moved < refine_px && turned < room_beside(what, start) || what < 0 && turned < refine_tolerance.x;
    float may = texelFetch(chosen, cell, 0).r, held = texelFetch(cell_classes, cell, 0).r;
#if MEETINGS
    bool whole = may < 1.0 || (texelFetch(cell_balls, cell, 0).r & narrow_balls) == 0u;
#else
    const bool whole = true;
#endif
    bool own = held < class_depth(PIXEL_OWN_RAY) + 0.05 || held > class_depth(PIXEL_THING) - 0.05;
    class_out = may > 0.0 && alike && whole && near ? class_depth(PIXEL_MATTER) : own ? held : class_depth(PIXEL_NEITHER);
}
