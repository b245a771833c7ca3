// Fetches hits from the hit map: those of the pixel's own ray, or interpolated between the rays of a coarse grid. What lies where in a texel is for hit_texels.glsl
// to know. The map is in the plan's frame, as a rule that of the camera's meridian, so that it serves a camera at any azimuth; what is fetched is in the world.
// HIT_MAP_REFINED: 1, pixels of cells that can be trusted have no ray of their own, and their hits are interpolated (hit_cells.glsl); 2, the
// same for directions in flat cells and nothing else (refine_classes.frag): linear interpolation does, and no own rays are looked for; 3, pixels of
// cells that one thing fills and nothing else. CELLS_FILLED: there may be such cells.
#include "common/rotation.glsl"
#include "common/hit_texels.glsl"
#include "common/hit_cells.glsl"
#if HIT_MAP_REFINED
#include "common/escape_chart.glsl"
#endif

uniform sampler2D hits0;
#if ORDERS > 0
uniform sampler2D hits1;
#endif
#if ORDERS > 1
uniform sampler2D hits2;
#endif
#if MEETINGS
uniform sampler2D met0, way0;
#endif
#if MEETINGS > 1
uniform sampler2D met1, way1;
#endif
#if RAYS_LIGHT_TRAVEL
uniform sampler2D times;
#endif
#if HIT_MAP_REFINED
uniform usampler2D cells;
uniform sampler2D coarse0; // these are filtered linearly
uniform sampler2D bend0;
#if ORDERS > 0
uniform sampler2D coarse1;
uniform sampler2D bend1;
#endif
#if ORDERS > 1
uniform sampler2D bend2;
#endif
#if MEETINGS && CELLS_FILLED
uniform sampler2D things_met, things_way; // and these
uniform sampler2D bend_x, bend_y;         // second differences of places on things (refine_bends.frag)
#endif

const vec2 UNSEEN_CROSSING = vec2(1e6, 0.0); // r_s; stands for one that is off the disk: so far out that no pixel beside it shows any
#endif

// Hits turned from the plan's frame to the world.
Hits in_world(Hits hits) {
    hits.direction.xy = rotate(hits.direction.xy, camera_heading);
    for (int n = 0; n < 3; ++n)
        hits.crossing[n] = rotate(hits.crossing[n], camera_heading);
    return hits;
}

// The texel of a pixel, clamped to the picture; `size` in pixels. All are the nearest: docs/llvmpipe.md, texels.
vec2 place_in_map(ivec2 pixel, ivec2 size) {
    return (vec2(pixel) + 0.5) / vec2(size);
}

vec4 texel_of(sampler2D hits, ivec2 pixel) {
    return textureLod(hits, place_in_map(pixel, textureSize(hits, 0)), 0.0);
}

#if HIT_MAP_REFINED
uint cell_of(ivec2 pixel) {
    return textureLod(cells, place_in_map(pixel, textureSize(cells, 0) * REFINE_STEP), 0.0).r;
}

// Where the coarse textures hold the pixel, for filtering.
vec2 place_in_grid(ivec2 pixel) {
    return (vec2(pixel) / float(REFINE_STEP) + float(GRID_MARGIN) + 0.5) / vec2(textureSize(coarse0, 0));
}

// Between nodes v is v_linear − s(1 − s)/2 · v_xx − t(1 − t)/2 · v_yy, the second differences v_xx and v_yy (`bend`) linear as well:
// it is continuous, and so are its slopes but for third differences.
vec2 interpolated(vec2 linear, sampler2D bend, vec2 place, ivec2 pixel) {
#if HIT_MAP_REFINED == 1
    vec4 bends = textureLod(bend, place, 0.0);
    vec2 s = vec2(pixel & (REFINE_STEP - 1)) * (1.0 / float(REFINE_STEP));
    vec2 weight = 0.5 * s * (s - 1.0);
    return linear + weight.x * bends.xy + weight.y * bends.zw;
#else
    return linear;
#endif
}

// Fate and direction of a pixel in a cell that is trusted, as hits0 would hold them.
vec4 interpolated_escape(ivec2 pixel) {
    vec2 place = place_in_grid(pixel);
    vec4 node = textureLod(coarse0, place, 0.0);
    if (node.w < -0.5) return escape_texel(vec3(0.0), CAPTURED, int(-1.0 - node.w));
    return escape_texel(chart_direction(interpolated(node.xy, bend0, place, pixel)), ESCAPED, int(node.w));
}

vec2 interpolated_crossing(uint cell, int n, vec2 point) {
    uint kind = cell_crossing(cell, n);
    return kind == CROSSING_SEEN ? point : kind == CROSSING_UNSEEN ? UNSEEN_CROSSING : vec2(0.0);
}

Hits interpolated_hits(uint cell, ivec2 pixel) {
    vec4 t1 = vec4(0.0), t2 = vec4(0.0);
    vec2 place = place_in_grid(pixel);
#if ORDERS > 0
    vec4 points = textureLod(coarse1, place, 0.0);
    t1 = first_texel(interpolated_crossing(cell, 0, interpolated(points.xy, bend1, place, pixel)), textureLod(coarse0, place, 0.0).z, float(cell_inbound(cell)));
#endif
#if ORDERS > 1
    t2 = vec4(interpolated_crossing(cell, 1, interpolated(points.zw, bend2, place, pixel)), interpolated_crossing(cell, 2, vec2(0.0)));
#endif
    return unpacked_hits(interpolated_escape(pixel), t1, t2);
}
#endif

#if HIT_MAP_REFINED && MEETINGS && CELLS_FILLED
// Of a pixel of a cell that one thing fills, as if traced.
Hits filled_hits(ivec2 pixel) {
    vec2 place = place_in_grid(pixel);
    vec2 s = vec2(pixel & (REFINE_STEP - 1)) * (1.0 / float(REFINE_STEP)), weight = 0.5 * s * (s - 1.0);
    vec4 met = textureLod(things_met, place, 0.0);  // what is met is the same at all four nodes
    met.xyz += weight.x * textureLod(bend_x, place, 0.0).xyz + weight.y * textureLod(bend_y, place, 0.0).xyz;
    Hits hits = no_hits(0.0);
    hits.fate = MET;
    hits.meeting[0] = unpacked_meeting(met, textureLod(things_way, place, 0.0), vec3(0.0) AND_TIME(0.0));
    return hits;
}
#endif

#if HIT_MAP_REFINED == 3
Hits fetch_hits(ivec2 pixel) {
    return in_world(filled_hits(pixel));
}
#elif HIT_MAP_REFINED < 2
// As traced, in the plan's frame.
Hits stored_hits(ivec2 pixel) {
    vec4 t1 = vec4(0.0), t2 = vec4(0.0);
#if HIT_MAP_REFINED
    uint cell = cell_of(pixel);
    if (!cell_has_own_rays(cell)) return interpolated_hits(cell, pixel);
#if MEETINGS && CELLS_FILLED
    if ((cell & CELL_FILLED) != 0u) return filled_hits(pixel);
#endif
#endif
#if ORDERS > 0
    t1 = texel_of(hits1, pixel);
#endif
#if ORDERS > 1
    t2 = texel_of(hits2, pixel);
#endif
    vec4 t0 = texel_of(hits0, pixel);
    Hits hits = unpacked_hits(t0, t1, t2);
#if RAYS_LIGHT_TRAVEL
    vec4 delays = texel_of(times, pixel);
    hits.delay = delays.xyz;  // of two meetings' the third is none of a crossing, and there is no such crossing
#endif
#if MEETINGS && HIT_MAP_REFINED
    if ((cell & CELL_WITHOUT_THINGS) != 0u) return hits;
#endif
#if MEETINGS
    hits.meeting[0] = unpacked_meeting(texel_of(met0, pixel), texel_of(way0, pixel), MEETINGS == 1 && hits.fate == MET ? t0.xyz : vec3(0.0) AND_TIME(delays.w));
#endif
#if MEETINGS > 1
    hits.meeting[1] = unpacked_meeting(texel_of(met1, pixel), texel_of(way1, pixel), vec3(0.0) AND_TIME(delays.z));
#endif
    return hits;
}

Hits fetch_hits(ivec2 pixel) {
    return in_world(stored_hits(pixel));
}
#endif

// Fate and direction only.
Hits fetch_escape(ivec2 pixel) {
#if HIT_MAP_REFINED == 0
    vec4 t0 = texel_of(hits0, pixel);
#elif HIT_MAP_REFINED == 1
    uint cell = cell_of(pixel);
    vec4 t0 = cell_has_own_rays(cell) ? texel_of(hits0, pixel) : interpolated_escape(pixel);
#if CELLS_FILLED
    if ((cell & CELL_FILLED) != 0u) t0 = escape_texel(vec3(0.0), MET, 0);
#endif
#else
    vec4 t0 = interpolated_escape(pixel);
#endif
    return in_world(unpacked_hits(t0, vec4(0.0), vec4(0.0)));
}

#if ORDERS > 0
// Relative drift of what the ray's model conserves, −1 where nothing was measured: only kept for the view that shows it.
float fetch_drift(ivec2 pixel) {
    return texel_of(hits1, pixel).w;
}
#endif
