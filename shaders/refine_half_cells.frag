#version 330 core
// Rays at every second pixel → for each 2×2 pixels the class of what is still to be done: PIXEL_MATTER where they are interpolated between these rays, that of their own
// rays where they are not, PIXEL_NEITHER where nothing is.
//
// Interpolated is where the rays at the corners and those around meet the same or go the same way, and where what is left out (common/row_error.glsl) displaces what is
// seen by less than refine_px, or light's direction by less than the angle of as many pixels: where a field crowds much of the sky into a pixel, the former. Where six in a
// row go the same way, all of them count; at an outline three will do (common/half_ways.glsl).
//
// What tells_apart is looked for again along the ray when it is shaded, from the part that a corner has met: places on it matter across the ray alone. Rays end alike on it
// where their parts lie side by side, and not one before the other; there an outline may be displaced in motion.
#defines
#include "common/constants.glsl"

#blocks
#include "common/hits.glsl"
#include "common/hit_texels.glsl"
#include "common/row_error.glsl"
#include "common/half_ways.glsl"

uniform sampler2D chosen;        // refine_half_marks.frag
uniform sampler2D cell_classes;
uniform sampler2D half_ends;     // of the rays, the nearest (docs/llvmpipe.md, texels): where they end and on what (refine_half_ends.frag); without things their hits, as traced
uniform vec2 refine_tolerance;   // refine_nodes.frag
uniform float refine_px;
#if MEETINGS
uniform sampler2D half0, half_way;  // hits, as traced
uniform usampler2D cell_balls;   // reach_cells.frag
uniform uint narrow_balls;       // those that may be seen narrower than the rays are apart
#endif

out float class_out;

// Whether rays end on what has many parts.
bool has_parts(int what) {
#if MEETINGS
#each thing_told_apart : if (what > 0 && (what & 31) == THING_$KEY + 1) return true;
#endif
    return false;
}

// Of a texel in the textures of rays.
vec2 middle_of(ivec2 node) {
    return (vec2(node) + 0.5) / vec2(textureSize(half_ends, 0));
}

// What a ray ends on, more than 0, or its fate, negative; 0 of a ray that ends nowhere. And where: a place or a direction.
int end_of(ivec2 node, out vec3 place) {
    vec4 end = textureLod(half_ends, middle_of(node), 0.0);
    place = end.xyz;
#if MEETINGS
    return int(round(end.w));
#else
    return -texel_fate(end);
#endif
}

// The normal of the part that a ray ends on, of what has some.
vec3 facing_at(ivec2 node) {
#if MEETINGS
    vec3 note = textureLod(half0, middle_of(node), 0.0).xyz;
    return note * inversesqrt(max(dot(note, note), 1e-20));
#else
    return vec3(0.0);
#endif
}

vec3 shorter(vec3 a, vec3 b) {
    return dot(a, a) < dot(b, b) ? a : b;
}

// The error of six nodes, of what they have beyond the middle four: the less, the smaller that is beside what those have beyond the middle two, as terms become small as fast.
const float OF_LAST = 0.5, OF_RATIO = 40.0, MOST_OF_LAST = 4.0;

// The same of three, of their second difference, and of the third where another lies behind them that goes the same way. Of a root, which is how places go at an outline, a
// quadratic leaves out an eighth of the second, as in refine_things.frag.
const float OF_THREE = 1.0 / 8.0, OF_FOUR = 1.0 / 16.0;

// Six nodes in a row, the cell between the middle two: where they end, and a bit for each that ends on `what`.
struct Row {
    vec3 place[6];
    int alike;
};

const int MIDDLE = 12, FIRST = 2, LAST = 16, ALL_SIX = 63;

bool is_there(ivec2 node) {
    return node == clamp(node, ivec2(0), textureSize(half_ends, 0) - 1);
}

// Whether places on what has parts lie side by side: either's part leads on to the other, in a step that is not much longer than what of it lies across the rays.
bool lie_together(vec3 apart, vec3 one_facing, vec3 other_facing, vec3 along) {
    const float BENT = 0.6, BEYOND = 2.0, MOST_SLANT = 5.0;
    float onward = dot(apart, along), away2 = dot(apart, apart), aside2 = away2 - onward * onward;
    float off = max(abs(dot(one_facing, apart)), abs(dot(other_facing, apart)));
    return off * off <= min(BENT * BENT * away2, BEYOND * BEYOND * aside2) && away2 <= MOST_SLANT * MOST_SLANT * aside2;
}

Row row_from(ivec2 first, ivec2 step, int what, bool of_parts, vec3 along) {
    Row row;
    row.alike = 0;
    for (int k = 0; k < 6; ++k) {
        ivec2 node = first + k * step;
        if (end_of(node, row.place[k]) == what && (k > 0 && k < 5 || is_there(node))) row.alike |= 1 << k;
    }
    if (of_parts) {
        vec3 facing[4];
        for (int k = 0; k < 4; ++k) facing[k] = facing_at(first + (k + 1) * step);
        for (int k = 1; k < 4; ++k)
            if (!lie_together(row.place[k + 1] - row.place[k], facing[k - 1], facing[k], along)) row.alike &= ~(k == 1 ? FIRST : k == 3 ? LAST : MIDDLE);
    }
    return row;
}

// By which of them to interpolate, of two rows side by side of which all these are alike; −1: by none.
int way_along(int alike) {
    if ((alike & MIDDLE) != MIDDLE) return -1;
    if ((alike & FIRST) != 0) return (alike & LAST) != 0 ? BY_FOUR : WITHOUT_LAST;
    return (alike & LAST) != 0 ? WITHOUT_FIRST : -1;
}

#if MEETINGS
// Whether what lies beyond the side of a cell where a ray at least ends on something else has three rays side by side, of the six along that side: else it may be a tip
// that comes in between two rays.
bool is_wide_beyond(ivec2 first, ivec2 step, int what) {
    bool other[6];
    vec3 place;
    for (int k = 0; k < 6; ++k)
        other[k] = end_of(first + k * step, place) != what;
    return other[2] && other[1] && (other[0] || other[3]) || other[3] && other[4] && (other[5] || other[2]);
}

bool are_sides_wide(ivec2 corner, int along_x, int along_y, int what) {
    bool wide = true;
    if (along_x != BY_FOUR) wide = is_wide_beyond(corner + ivec2(along_x == WITHOUT_FIRST ? -1 : 2, -2), ivec2(0, 1), what);
    if (along_y != BY_FOUR) wide = is_wide_beyond(corner + ivec2(-2, along_y == WITHOUT_FIRST ? -1 : 2), ivec2(1, 0), what) && wide;
    return wide;
}
#endif

vec3 error_of_three(vec3 a, vec3 b, vec3 c, vec3 behind, bool is_behind) {
    vec3 second = c - 2.0 * b + a;
    return is_behind ? OF_FOUR * (behind - 2.0 * c + b - second) + OF_SECOND * second : OF_THREE * second;
}

vec3 error_of(Row row, int what, int way, bool by_six) {
    vec3 mean = 0.5 * (row.place[2] + row.place[3]), about = 0.5 * (row.place[1] + row.place[4]), last = beyond_cubic(mean, about, 0.5 * (row.place[0] + row.place[5]));
    if (by_six) return min(OF_LAST + OF_RATIO * length(last) / max(length(about - mean), 1e-12), MOST_OF_LAST) * last;
#if MEETINGS
    if (way == WITHOUT_FIRST) return error_of_three(row.place[2], row.place[3], row.place[4], row.place[5], what < 0 && (row.alike & 32) != 0);
    if (way == WITHOUT_LAST) return error_of_three(row.place[3], row.place[2], row.place[1], row.place[0], what < 0 && (row.alike & 1) != 0);
#endif
    return row_error(vec3[4](row.place[1], row.place[2], row.place[3], row.place[4]));
}

// From pixel to pixel. Where one part of a thing hides another, places jump within the cell, and change little beside it: the least counts.
vec3 slope_of(Row row, int what, int way) {
    vec3 slope = row.place[3] - row.place[2];
    bool may_jump = what > 0 && !has_parts(what);
    if (may_jump && way != WITHOUT_FIRST) slope = shorter(slope, row.place[2] - row.place[1]);
    if (may_jump && way != WITHOUT_LAST) slope = shorter(slope, row.place[4] - row.place[3]);
    return 0.5 * slope;
}

vec3 across(vec3 v, vec3 along) {
    return v - dot(v, along) * along;
}

void main() {
    ivec2 pixels = ivec2(gl_FragCoord.xy), cell = pixels / 2, corner = pixels + HALF_MARGIN;
    vec3 start, along = vec3(0.0), error[4];
    int what = end_of(corner, start);
    bool of_parts = has_parts(what);
#if MEETINGS
    if (of_parts) {
        vec4 way = texelFetch(half_way, corner, 0);
        float r = length(start);
        along = normalize((0.5 / r) * way.xyz - (way.w / r) * start);
    }
#endif
    Row rows[4];
    for (int k = 0; k < 4; ++k) {
        ivec2 onward = k < 2 ? ivec2(1, 0) : ivec2(0, 1);
        rows[k] = row_from(corner + (k & 1) * onward.yx - 2 * onward, onward, what, of_parts, along);
    }
    int along_x = way_along(rows[0].alike & rows[1].alike), along_y = way_along(rows[2].alike & rows[3].alike);
    bool by_six = what < 0 && (rows[0].alike & rows[1].alike & rows[2].alike & rows[3].alike) == ALL_SIX;
#if MEETINGS
    bool alike = what != 0 && min(along_x, along_y) >= 0 && (of_parts || are_sides_wide(corner, along_x, along_y, what));
#else
    bool alike = what != 0 && along_x == BY_FOUR && along_y == BY_FOUR;
#endif
    for (int k = 0; k < 4; ++k)
        error[k] = across(error_of(rows[k], what, k < 2 ? along_x : along_y, by_six), along);
    vec3 right = 0.5 * across(slope_of(rows[0], what, along_x) + slope_of(rows[1], what, along_x), along);
    vec3 up = 0.5 * across(slope_of(rows[2], what, along_y) + slope_of(rows[3], what, along_y), along);
    float moved = 0.0, turned = 0.0;
    for (int k = 0; k < 2; ++k) {
        moved = max(moved, displacement(right, up, error[k], error[2 + k]));
        turned = max(turned, length(error[k]) + length(error[2 + k]));
    }
    bool near = moved < refine_px || what < 0 && turned < refine_tolerance.x;
    float may = texelFetch(chosen, cell, 0).r, held = texelFetch(cell_classes, cell, 0).r;
#if MEETINGS
    bool whole = may < 1.0 || (texelFetch(cell_balls, cell, 0).r & narrow_balls) == 0u;
#else
    const bool whole = true;
#endif
    bool own = held < class_depth(PIXEL_OWN_RAY) + 0.05 || held > class_depth(PIXEL_THING) - 0.05;
    class_out = may > 0.0 && alike && whole && near ? with_way(along_x, along_y, by_six) : own ? held : class_depth(PIXEL_NEITHER);
}
