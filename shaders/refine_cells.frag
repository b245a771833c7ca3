#version 330 core
// Nodes → which cells of the coarse grid can be interpolated, and how (common/hit_cells.glsl), and the class of their pixels.
//
// A cell may be interpolated where its corners and the nodes around them have one fate, where no crossing that matters comes or goes among
// them, and where nothing bends too much for the tolerance (refine_nodes.frag); and where no thing or medium can be seen (reach_cells.frag).
#defines
#blocks
#include "common/constants.glsl"
#include "common/hit_cells.glsl"
#include "common/node_kinds.glsl"
#include "common/reach_node.glsl"

uniform usampler2D kinds;
#if MEETINGS
uniform sampler2D reached; // what each cell may show (common/reach_node.glsl)
#endif
#if CELLS_FILLED
uniform sampler2D solid;   // 1 for each that one thing fills
#endif

layout(location = 0) out uint cell_out;
layout(location = 1) out float class_out;

// Where some nodes have a crossing and others none, it runs off to infinity between them, away from the camera.
bool matters(uint crossing) {
    return has_all(crossing, NODE_BELOW_OUTER_MARGIN | NODE_ABOVE_INNER_MARGIN) || has_all(crossing, NODE_MISSES | NODE_BEFORE_DISK);
}

// What to make of a crossing of these kinds and senses; `trusted` falls where the cell cannot be interpolated.
uint crossing_kind(uint crossing, uint senses, inout bool trusted, inout bool disk) {
#if DISK_PLUNGING || DISK_TILTED
    bool turns = has_all(senses, NODE_OUTBOUND | NODE_INBOUND);
#else
    const bool turns = false; // of light from circular orbits about the hole's axis the constants of motion tell all
#endif
    trusted = trusted && (!matters(crossing) || ((crossing & (NODE_MISSES | NODE_BENDS)) == 0u && !turns));
    disk = disk || has_all(crossing, NODE_BELOW_OUTER_EDGE | NODE_ABOVE_INNER_EDGE);
    return matters(crossing) ? CROSSING_SEEN : (crossing & NODE_CROSSES) != 0u ? CROSSING_UNSEEN : CROSSING_NONE;
}

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) + GRID_MARGIN;
    uvec4 kind = uvec4(texelFetch(kinds, corner, 0).r, texelFetch(kinds, corner + ivec2(1, 0), 0).r, texelFetch(kinds, corner + ivec2(0, 1), 0).r, texelFetch(kinds, corner + ivec2(1, 1), 0).r);
    uint any = kind.x | kind.y | kind.z | kind.w;
    uint fate = kind.x & 3u;
    bool trusted = fate != uint(UNRESOLVED) && (kind & 3u) == uvec4(fate) && (any & NODE_DIRECTION_BENDS) == 0u;
    uint cell = fate;
    bool disk = false; // the nodes around a cell leave room for the width of its pixels
#if ORDERS > 0
    cell |= crossing_kind(any >> NODE_CROSSING_BITS(0), any >> NODE_SENSE_BITS(0), trusted, disk) << 2;
    cell |= (any >> NODE_SENSE_BITS(0) & NODE_INBOUND) << 9;
#endif
#if ORDERS > 1
    cell |= crossing_kind(any >> NODE_CROSSING_BITS(1), any >> NODE_SENSE_BITS(1), trusted, disk) << 4;
    cell |= (any >> NODE_SENSE_BITS(1) & NODE_INBOUND) << 10;
#endif
#if ORDERS > 2
    uint third = any >> NODE_CROSSING_BITS(2);
    trusted = trusted && !matters(third);
    cell |= crossing_kind(third, 0u, trusted, disk) << 6;
#endif
    // The hole's own cells are always traced: from far away it can be smaller than a cell.
    vec2 from_hole = abs(float(REFINE_STEP) * gl_FragCoord.xy + picture_offset - picture_hole);
    trusted = trusted && max(from_hole.x, from_hole.y) > float(REFINE_STEP);
#if MEETINGS
    float shown = texelFetch(reached, ivec2(gl_FragCoord.xy), 0).r;
    bool things = shown > REACHED_NONE && !(trusted && is_near(shown));
#else
    const bool things = false;
#endif
#if CELLS_FILLED
    bool filled = texelFetch(solid, corner, 0).r > 0.0;
#else
    const bool filled = false;
#endif
    trusted = trusted && !things;
    cell_out = trusted ? cell | (disk ? 256u : 0u) : filled ? CELL_FILLED : things ? 0u : CELL_WITHOUT_THINGS;
    bool flat_sky = fate == uint(ESCAPED) && (any & NODE_DIRECTION_CURVES) == 0u;
    int shared_class = disk ? PIXEL_MATTER : flat_sky ? PIXEL_FLAT_SKY : fate == uint(ESCAPED) ? PIXEL_SKY : PIXEL_NEITHER;
    class_out = class_depth(trusted ? shared_class : filled ? PIXEL_SOLID_THING : things ? PIXEL_THING : PIXEL_OWN_RAY);
}
