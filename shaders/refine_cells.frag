#version 330 core
// Coarse hits → which cells of the coarse grid can be interpolated, and how (common/hit_cells.glsl).
//
// A cell may be interpolated where it and its neighbours have one fate, where no crossing that matters comes or goes, and where bilinear
// interpolation keeps within refine_tolerance: its error is at most (|f_xx| + |f_yy|)/8, with the largest second differences over the
// cell; those on its four sides stand for them. Bound as hits0…hits2 are the coarse textures.
#defines
#blocks
#include "common/constants.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"

uniform vec3 refine_tolerance; // of directions, rad; of crossings, for each r_s from the camera (parallel rays: r_s); how far beyond the disk's edges crossings still matter, as a ratio of radii

out uint cell_out;

// The cell's corners, and the nodes that lie one further on each of its sides' lines.
#define EACH_NODE(f) f(0, 0, 0) f(1, 1, 0) f(2, 0, 1) f(3, 1, 1) f(4, -1, 0) f(5, 2, 0) f(6, -1, 1) f(7, 2, 1) f(8, 0, -1) f(9, 0, 2) f(10, 1, -1) f(11, 1, 2)

float bend(vec3 before, vec3 here, vec3 after) {
    return length(before - 2.0 * here + after);
}

// Bound on the error of bilinear interpolation in the cell.
float interpolation_error(vec3 v[12]) {
    float along_x = max(max(bend(v[4], v[0], v[1]), bend(v[0], v[1], v[5])), max(bend(v[6], v[2], v[3]), bend(v[2], v[3], v[7])));
    float along_y = max(max(bend(v[8], v[0], v[2]), bend(v[0], v[2], v[9])), max(bend(v[10], v[1], v[3]), bend(v[1], v[3], v[11])));
    return 0.125 * (along_x + along_y);
}

// What to make of a crossing that lies at these points, as the lowest bits of a cell; `trusted` falls where the cell cannot be interpolated.
uint crossing_kind(vec3 point[12], inout bool trusted, inout bool disk) {
    float nearest = 1e30, farthest = 0.0, smallest = 1e30;
    for (int i = 0; i < 12; ++i) {
        float r2 = dot(point[i], point[i]);
        nearest = min(nearest, r2 > 0.0 ? r2 : 1e30);
        farthest = max(farthest, r2);
        smallest = min(smallest, r2);
    }
    float away = camera_w > 0.0 ? distance(0.5 / camera_w * camera_n.xyz, point[0]) : 1.0;
    vec2 edges = vec2(disk_r_in / refine_tolerance.z, disk_r_out * refine_tolerance.z);
    bool matters = nearest < edges.y * edges.y && farthest > edges.x * edges.x;
    trusted = trusted && (!matters || smallest > 0.0 && interpolation_error(point) < refine_tolerance.y * away);
    disk = disk || nearest <= disk_r_out * disk_r_out && farthest >= disk_r_in * disk_r_in;
    return matters ? CROSSING_SEEN : farthest > 0.0 ? CROSSING_UNSEEN : CROSSING_NONE;
}

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) + 1;
    vec3 v[12], u[12];

#define ESCAPE(k, i, j) vec4 e##k = texelFetch(hits0, corner + ivec2(i, j), 0); v[k] = e##k.xyz;
    EACH_NODE(ESCAPE)
    int fate = int(e0.w + 0.5) & 3;
    bool trusted = fate != UNRESOLVED && interpolation_error(v) < refine_tolerance.x;
#define SAME_FATE(k, i, j) trusted = trusted && (int(e##k.w + 0.5) & 3) == fate;
    EACH_NODE(SAME_FATE)
    uint cell = uint(fate);
    bool disk = false; // the nodes around a cell leave room for the width of its pixels
#if ORDERS > 0
#define FIRST(k, i, j) v[k] = vec3(texelFetch(hits1, corner + ivec2(i, j), 0).xy, 0.0);
    EACH_NODE(FIRST)
    cell |= crossing_kind(v, trusted, disk) << 2;
#endif
#if ORDERS > 1
#define OTHERS(k, i, j) vec4 c##k = texelFetch(hits2, corner + ivec2(i, j), 0); v[k] = vec3(c##k.xy, 0.0); u[k] = vec3(c##k.zw, 0.0);
    EACH_NODE(OTHERS)
    cell |= crossing_kind(v, trusted, disk) << 4;
#endif
#if ORDERS > 2
    cell |= crossing_kind(u, trusted, disk) << 6;
#endif
    // The hole's own cells are always traced: from far away it can be smaller than a cell.
    vec2 from_centre = abs(float(REFINE_STEP) * gl_FragCoord.xy + picture_offset - 0.5 * picture_size);
    trusted = trusted && max(from_centre.x, from_centre.y) > float(REFINE_STEP);
    cell_out = trusted ? cell | (disk ? 256u : 0u) : 0u;
}
