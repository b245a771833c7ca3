#version 330 core
// Hit map → lines that are no light, over the radiance and as bright as they are whatever the exposure: where the disk's plane, the sky or the horizon is seen.
// OVERLAY_SKY: the lines of the sky, which matter hides; else all others.
//
// A line is as wide on the picture everywhere: how far a pixel is from it is what differs there over how much that changes to the next pixels. Where the ray
// map is torn towards one of those the other tells both; where it is torn towards both nothing is drawn. Lines that crowd together fade out.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_plane.glsl"

#if HIT_MAP_REFINED
const float block_side = 1.0;
#else
uniform float block_side;   // rays along each axis of a pixel
#endif

out vec4 line;  // colour × share, share

const float PI = 3.14159265;
const float WIDTH = 0.0016;      // of a line, in heights of the picture; no less than a pixel
const float LEVEL = 0.6;         // of their colours: tone curves bleach what is bright
const float CROWDED = 0.25;      // lines a pixel from which on they fade
const float TORN = 0.5;          // of a radius: what changes more from pixel to pixel is no piece of one image

void lay(vec3 colour, float share) {
    line = vec4(colour * share, share) + line * (1.0 - share);
}

// Share of the pixel that a line `away` pixels from its middle covers.
float covered(float away) {
    return clamp(0.5 * max(WIDTH * picture_size.y, 1.0) + 0.5 - away, 0.0, 1.0);
}

// How much two numbers, whose changes to the pixel on the right and to that above are known unless `parts` there, change from pixel to pixel.
vec2 changes(vec2 right, vec2 up, bvec2 parts) {
    vec2 along = parts.x ? up : right, across = parts.y ? right : up;
    return max(sqrt(along * along + across * across), 1e-9);
}

#if OVERLAY_SKY || POST_SHOW_PLANE_GRID
// The same of the lines on which `x` is whole; `change`: of x from pixel to pixel.
float covered_by_lines(float x, float change) {
    return covered(abs(fract(x - 0.5) - 0.5) / change) * clamp(2.0 - change / CROWDED, 0.0, 1.0);
}
#endif

#if OVERLAY_SKY
const vec3 SKY_COLOUR = vec3(0.16, 0.34, 0.62);
const float SKY_STEP = PI / 12.0;

void draw_lines(Hits hits) {
    vec3 at = hits.direction, right = block_side * dFdx(at), up = block_side * dFdy(at);
    float escaped = hits.fate == ESCAPED ? 1.0 : 0.0;
    bvec2 parts = bvec2(dFdx(escaped) != 0.0, dFdy(escaped) != 0.0);
    bool whole = escaped > 0.0 && !all(parts);
    float flat2 = max(dot(at.xy, at.xy), 1e-9);
    vec2 change = changes(vec2(right.z, at.x * right.y - at.y * right.x), vec2(up.z, at.x * up.y - at.y * up.x), parts);
    float north = change.x * inversesqrt(flat2), east = change.y / flat2;
    float latitude = atan(at.z, sqrt(flat2)), longitude = atan(at.y, at.x);
    float lines = max(covered_by_lines(latitude / SKY_STEP, north / SKY_STEP), covered_by_lines(longitude / SKY_STEP, east / SKY_STEP));
    float equator = covered(abs(latitude) / north);
    if (whole) lay(SKY_COLOUR, 0.55 * lines);
    if (whole) lay(1.6 * SKY_COLOUR, 0.8 * equator);
}
#else

#if POST_SHOW_ERGOSPHERE || POST_SHOW_PHOTON_SHELL || POST_SHOW_ISCO
uniform vec4 plane_radii;  // r_s, 0 without a hole: innermost stable orbit, light with the spin, light against it; a*²
#endif

const float FAINTER = 0.6;  // each further image

void draw_crossing(vec2 point, float share) {
    float r = length(point), present = r > 0.0 ? 1.0 : 0.0;
    vec2 right = block_side * dFdx(point), up = block_side * dFdy(point);
    bvec2 parts = bvec2(dFdx(present) != 0.0 || length(right) > TORN * r, dFdy(present) != 0.0 || length(up) > TORN * r);
    vec2 turn = vec2(-point.y, point.x);
    vec2 radial_and_round = changes(vec2(dot(right, point), dot(right, turn)), vec2(dot(up, point), dot(up, turn)), parts);
    if (r == 0.0 || all(parts)) return;
    float change = radial_and_round.x / r;
#if POST_SHOW_PLANE_GRID
    float lines = max(covered_by_lines(r, change), covered_by_lines(atan(point.y, point.x) * (6.0 / PI), radial_and_round.y / (r * r) * (6.0 / PI)));
    lay(vec3(0.30, 0.62, 0.50), r < disk_r_out + change ? 0.55 * share * lines : 0.0);
#endif
#if POST_SHOW_PHOTON_SHELL
    lay(vec3(0.95, 0.80, 0.25), share * (r > plane_radii.y && r < plane_radii.z ? 0.25 : 0.0));
    float inner = covered(abs(r - plane_radii.y) / change) * clamp((plane_radii.y - crossing_r_min) / change, 0.0, 1.0); // beside the horizon it would be dots
    lay(vec3(0.95, 0.80, 0.25), 0.9 * share * max(inner, covered(abs(r - plane_radii.z) / change)));
#endif
#if POST_SHOW_ERGOSPHERE
    float cosine = disk_place(point).z / r;
    float edge = 0.5 + 0.5 * sqrt(max(1.0 - plane_radii.w * cosine * cosine, 0.0));
    lay(vec3(0.70, 0.35, 0.90), 0.9 * share * (plane_radii.w > 0.0 ? covered(abs(r - edge) / change) : 0.0));
#endif
#if POST_SHOW_ISCO
    lay(vec3(0.95, 0.45, 0.15), 0.9 * share * covered(abs(r - plane_radii.x) / change));
#endif
}

void draw_lines(Hits hits) {
#if POST_SHOW_HORIZON
    lay(vec3(0.10, 0.14, 0.42), hits.fate == CAPTURED ? 0.45 : 0.0);
#endif
#if POST_SHOW_ERGOSPHERE || POST_SHOW_PHOTON_SHELL || POST_SHOW_ISCO || POST_SHOW_PLANE_GRID
    float share = 1.0;
    for (int n = 0; n < ORDERS; ++n) {
        draw_crossing(hits.crossing[n], share);
        share *= FAINTER;
    }
#endif
}
#endif

void main() {
    line = vec4(0.0);
    draw_lines(fetch_hits(ivec2(gl_FragCoord.xy)));
    line.rgb *= LEVEL * exp2(-post_exposure);
}
