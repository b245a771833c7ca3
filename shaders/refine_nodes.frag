#version 330 core
// Coarse hits → nodes: what is interpolated between them, with its second differences from the nodes around (common/hit_cells.glsl), and
// what the node and its four neighbours are like (common/node_kinds.glsl), for refine_cells.frag. Bound as hits0…hits2 are the coarse rays.
//
// Interpolation takes the second differences along, so what it leaves out begins with the third: s(1 − s)(1 − 2s)/6 ≤ 0.016 of a third difference
// along a cell's side, and 3/128 of a fourth, which is not known. Where light is bent most (towards the critical curve the map goes as the
// logarithm of the distance) the fourth is the third's equal when the tolerance is reached.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_texels.glsl"
#include "common/escape_chart.glsl"
#include "common/node_kinds.glsl"
#include "common/disk_plane.glsl"

uniform sampler2D hits0;
#if ORDERS > 0
uniform sampler2D hits1;
#endif
#if ORDERS > 1
uniform sampler2D hits2;
#endif
uniform vec2 refine_tolerance; // of directions, rad; of crossings, for each r_s from the camera (parallel rays: r_s)
uniform float beyond_disk;     // how far beyond the disk's edges crossings still matter, as a ratio of radii

layout(location = 0) out uint kinds_out;
layout(location = 1) out vec4 coarse0_out;
layout(location = 2) out vec4 bend0_out;
#if ORDERS > 0
layout(location = 3) out vec4 coarse1_out;
layout(location = 4) out vec4 bend1_out;
#endif
#if ORDERS > 1
layout(location = 5) out vec4 bend2_out;
#endif

// A node and its neighbours: left and right, below and above.
const vec2 STAR[5] = vec2[5](vec2(0.0), vec2(-1.0, 0.0), vec2(1.0, 0.0), vec2(0.0, -1.0), vec2(0.0, 1.0));

#define FETCH_STAR(name, hits) vec4 name[5]; for (int i = 0; i < 5; ++i) name[i] = textureLod(hits, (place + STAR[i]) * texel, 0.0);

// Second differences: along x, along y.
vec4 bend_of(vec2 v[5]) {
    return vec4(v[1] - 2.0 * v[0] + v[2], v[3] - 2.0 * v[0] + v[4]);
}

// Shares of the differences that stand for the error, twice those above and more, found by trial: tests/shaders/test_refinement.py holds
// every pixel to the tolerance. Crossings are rougher than directions: where light grazes the plane, and beside the hole, they run off.
const float OF_THIRD = 1.0 / 32.0;
const float OF_FOURTH = 1.0 / 48.0;  // of third²/second: where the map goes as a logarithm the fourth is 3/2 of that
const float OF_SECOND = 1.0 / 256.0;
const float ROUGH = 2.0;

// Linear interpolation errs by an eighth of the second differences: a direction is flat where that is this share of the tolerance. Its slope jumps between
// cells by a quarter of them, from one pixel to the next, and stars shine by the slope: at a twenty-fifth of a pixel they jump by less than a tenth.
const float FLAT = 0.1;

// The estimate beside the node, and the bound for linear interpolation. The difference to the next fragment of the quad is a third difference; on a
// cell's sides between two quads it lies between those of its neighbours.
vec2 interpolation_error(vec4 bend) {
    vec2 along_x = dFdx(bend.xy), along_y = dFdy(bend.zw);
    float second = length(bend.xy) + length(bend.zw);
    float third = length(along_x) + length(along_y);
    return vec2(OF_THIRD * third + OF_FOURTH * third * third / max(second, 1e-12) + OF_SECOND * second, 0.125 * second);
}

uint kind_of_direction(vec2 point, vec4 bend) {
    vec2 error = chart_scale(point) * interpolation_error(bend);
    return (error.x < refine_tolerance.x ? 0u : NODE_DIRECTION_BENDS) | (error.y < FLAT * refine_tolerance.x ? 0u : NODE_DIRECTION_CURVES);
}

uint kind_of_crossing(vec2 point, vec4 bend) {
    float away = camera_w > 0.0 ? distance(0.5 / camera_w * camera_n.xyz, disk_place(point)) : 1.0;
    return ROUGH * interpolation_error(bend).x < refine_tolerance.y * away ? 0u : NODE_BENDS;
}

uint kinds_of_fates(vec4 star[5]) {
    int fate = texel_fate(star[0]);
    for (int i = 1; i < 5; ++i)
        fate = texel_fate(star[i]) == fate ? fate : UNRESOLVED;
    return uint(fate);
}

uint senses_of_crossings(int n, vec2 point[5], vec4 star[5]) {
    uint senses = 0u;
    for (int i = 0; i < 5; ++i)
        senses |= point[i] == vec2(0.0) ? 0u : (int(star[i].w + 0.5) >> n & 1) == 1 ? NODE_INBOUND : NODE_OUTBOUND;
    return senses;
}

// The points' bounding box counts, and not the points: seen from near its plane the disk is thinner than a cell, and no ray may meet it.
uint kinds_of_crossings(vec2 point[5]) {
    vec2 margin = vec2(disk_r_edge / beyond_disk, disk_r_out * beyond_disk);
    float far_side = camera_w > 0.0 ? 0.5 / camera_w + margin.y : 0.0;
    vec2 low = vec2(1e30), high = vec2(-1e30);
    uint kinds = 0u;
    for (int i = 0; i < 5; ++i) {
        float r2 = dot(point[i], point[i]);
        bool outside = r2 > margin.x * margin.x;
        vec3 seen = disk_place(point[i]) - (0.5 / max(camera_w, 1e-20)) * camera_n.xyz;
        uint found = NODE_CROSSES | (outside ? NODE_ABOVE_INNER_MARGIN : 0u) | (r2 >= disk_r_edge * disk_r_edge ? NODE_ABOVE_INNER_EDGE : 0u);
        found |= outside && dot(seen, seen) < far_side * far_side ? NODE_BEFORE_DISK : 0u;
        kinds |= r2 > 0.0 ? found : NODE_MISSES;
        low = r2 > 0.0 ? min(low, point[i]) : low;
        high = r2 > 0.0 ? max(high, point[i]) : high;
    }
    vec2 nearest = clamp(vec2(0.0), low, high);
    float r2 = (kinds & NODE_CROSSES) != 0u ? dot(nearest, nearest) : 1e30;
    return kinds | (r2 < margin.y * margin.y ? NODE_BELOW_OUTER_MARGIN : 0u) | (r2 <= disk_r_out * disk_r_out ? NODE_BELOW_OUTER_EDGE : 0u);
}

void main() {
    // The outermost nodes are no cell's corners, and have no neighbours on one side: they do as the next one does. The next ones are no corners either, but a corner
    // at the picture's edge may share its quad with one, and needs its second differences.
    vec2 size = vec2(textureSize(hits0, 0)), texel = 1.0 / size;
    vec2 place = clamp(gl_FragCoord.xy, vec2(1.5), size - 1.5);
    vec2 v[5];
    FETCH_STAR(escapes, hits0)
    for (int i = 0; i < 5; ++i)
        v[i] = chart_point(escapes[i].xyz);
    bend0_out = bend_of(v);
    kinds_out = kinds_of_fates(escapes) | kind_of_direction(v[0], bend0_out);
    float steps = texel_steps(escapes[0]);
    coarse0_out = vec4(v[0], 0.0, texel_fate(escapes[0]) == ESCAPED ? steps : -1.0 - steps);
#if ORDERS > 0
    FETCH_STAR(first, hits1)
    for (int i = 0; i < 5; ++i)
        v[i] = first[i].xy;
    bend1_out = bend_of(v);
    kinds_out |= (kinds_of_crossings(v) | kind_of_crossing(v[0], bend1_out)) << NODE_CROSSING_BITS(0);
    kinds_out |= senses_of_crossings(0, v, first) << NODE_SENSE_BITS(0);
    coarse0_out.z = first[0].z;
    coarse1_out = vec4(v[0], vec2(0.0));
#endif
#if ORDERS > 1
    FETCH_STAR(others, hits2)
    for (int i = 0; i < 5; ++i)
        v[i] = others[i].xy;
    bend2_out = bend_of(v);
    kinds_out |= (kinds_of_crossings(v) | kind_of_crossing(v[0], bend2_out)) << NODE_CROSSING_BITS(1);
    kinds_out |= senses_of_crossings(1, v, first) << NODE_SENSE_BITS(1);
    coarse1_out.zw = v[0];
#endif
#if ORDERS > 2
    for (int i = 0; i < 5; ++i)
        v[i] = others[i].zw;
    kinds_out |= kinds_of_crossings(v) << NODE_CROSSING_BITS(2);
#endif
}
