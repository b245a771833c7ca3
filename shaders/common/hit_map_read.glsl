// Reads hits from the hit map. The other half is hit_map_write.glsl.
// The map is in the frame of the camera's meridian, so that it serves a camera at any azimuth; what is fetched is in the world.
// HIT_MAP_REFINED: pixels of cells that can be trusted have no ray of their own; their hits are interpolated (hit_cells.glsl).
#include "common/rotation.glsl"
#include "common/hit_cells.glsl"

uniform sampler2D hits0;
#if ORDERS > 0
uniform sampler2D hits1;
#endif
#if ORDERS > 1
uniform sampler2D hits2;
#endif
#if HIT_MAP_REFINED
uniform usampler2D cells;
uniform sampler2D coarse0; // filtered linearly
#if ORDERS > 0
uniform sampler2D coarse1;
#endif
#if ORDERS > 1
uniform sampler2D coarse2;
#endif

const vec2 UNSEEN_CROSSING = vec2(1e6, 0.0); // r_s; stands for one that is off the disk: so far out that no pixel beside it shows any
#endif

// The hits in the texels of the three textures; those of textures that are not there are vec4(0).
Hits unpacked_hits(vec4 t0, vec4 t1, vec4 t2) {
    int packed_fate = int(t0.w + 0.5);
    return Hits(packed_fate & 3, t0.xyz, t1.z, packed_fate >> 2, vec2[3](t1.xy, t2.xy, t2.zw));
}

// Hits turned from the camera's meridian to the world.
Hits in_world(Hits hits) {
    hits.direction.xy = rotate(hits.direction.xy, camera_heading);
    for (int n = 0; n < 3; ++n)
        hits.crossing[n] = rotate(hits.crossing[n], camera_heading);
    return hits;
}

ivec2 place_in_map(ivec2 pixel) {
    return clamp(pixel, ivec2(0), textureSize(hits0, 0) - 1);
}

#if HIT_MAP_REFINED
// Where the coarse textures hold the pixel, for filtering.
vec2 place_in_grid(ivec2 pixel) {
    return (vec2(pixel) / float(REFINE_STEP) + 1.5) / vec2(textureSize(coarse0, 0));
}

// Fate and direction of a pixel in the middle of a cell that is trusted.
vec4 interpolated_escape(uint cell, vec2 place) {
    vec4 t0 = textureLod(coarse0, place, 0.0);
    uint fate = cell & 3u;
    float steps = floor(0.25 * t0.w);
    return vec4(fate == uint(ESCAPED) ? normalize(t0.xyz) : vec3(0.0), 4.0 * steps + float(fate));
}

vec2 interpolated_crossing(uint cell, int n, vec2 point) {
    uint kind = cell_crossing(cell, n);
    return kind == CROSSING_SEEN ? point : kind == CROSSING_UNSEEN ? UNSEEN_CROSSING : vec2(0.0);
}
#endif

// As traced, in the frame of the camera's meridian.
Hits stored_hits(ivec2 pixel) {
    ivec2 place = place_in_map(pixel);
    vec4 t0 = texelFetch(hits0, place, 0), t1 = vec4(0.0), t2 = vec4(0.0);
#if ORDERS > 0
    t1 = texelFetch(hits1, place, 0);
#endif
#if ORDERS > 1
    t2 = texelFetch(hits2, place, 0);
#endif
#if HIT_MAP_REFINED
    uint cell = texelFetch(cells, place / REFINE_STEP, 0).r;
    bool own = cell_has_own_rays(cell);
    vec2 between = place_in_grid(place);
    t0 = own ? t0 : interpolated_escape(cell, between);
#if ORDERS > 0
    vec4 u1 = textureLod(coarse1, between, 0.0);
    t1 = own ? t1 : vec4(interpolated_crossing(cell, 0, u1.xy), u1.z, 0.0);
#endif
#if ORDERS > 1
    vec4 u2 = textureLod(coarse2, between, 0.0);
    t2 = own ? t2 : vec4(interpolated_crossing(cell, 1, u2.xy), interpolated_crossing(cell, 2, u2.zw));
#endif
#endif
    return unpacked_hits(t0, t1, t2);
}

Hits fetch_hits(ivec2 pixel) {
    return in_world(stored_hits(pixel));
}

// Fate and direction only.
Hits fetch_escape(ivec2 pixel) {
    ivec2 place = place_in_map(pixel);
    vec4 t0 = texelFetch(hits0, place, 0);
#if HIT_MAP_REFINED
    uint cell = texelFetch(cells, place / REFINE_STEP, 0).r;
    t0 = cell_has_own_rays(cell) ? t0 : interpolated_escape(cell, place_in_grid(place));
#endif
    return in_world(unpacked_hits(t0, vec4(0.0), vec4(0.0)));
}

#if ORDERS > 0
// Relative drift of what the ray's model conserves, −1 where nothing was measured: only kept for the view that shows it.
float fetch_drift(ivec2 pixel) {
    return texelFetch(hits1, place_in_map(pixel), 0).w;
}
#endif
