// Reads hits from the hit map. The other half is hit_map_write.glsl.

uniform sampler2D hits0;
#if ORDERS > 0
uniform sampler2D hits1;
#endif
#if ORDERS > 1
uniform sampler2D hits2;
#endif

// Fate and direction only, for footprints: `pixel` is clamped to the map.
Hits fetch_escape(ivec2 pixel) {
    vec4 t0 = texelFetch(hits0, clamp(pixel, ivec2(0), textureSize(hits0, 0) - 1), 0);
    Hits hits = no_hits(0.0);
    int packed_fate = int(t0.w + 0.5);
    hits.fate = packed_fate & 3;
    hits.steps = packed_fate >> 2;
    hits.direction = t0.xyz;
    return hits;
}

Hits fetch_hits(ivec2 pixel) {
    Hits hits = fetch_escape(pixel);
#if ORDERS > 0
    ivec2 place = clamp(pixel, ivec2(0), textureSize(hits0, 0) - 1);
    vec4 t1 = texelFetch(hits1, place, 0);
    hits.crossing[0] = t1.xy;
    hits.lambda = t1.z;
#endif
#if ORDERS > 1
    vec4 t2 = texelFetch(hits2, place, 0);
    hits.crossing[1] = t2.xy;
    hits.crossing[2] = t2.zw;
#endif
    return hits;
}
