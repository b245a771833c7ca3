// Reads hits from the hit map. The other half is hit_map_write.glsl.
// The map is in the frame of the camera's meridian, so that it serves a camera at any azimuth; what is fetched is in the world.
#include "common/rotation.glsl"

uniform sampler2D hits0;
#if ORDERS > 0
uniform sampler2D hits1;
#endif
#if ORDERS > 1
uniform sampler2D hits2;
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

// Fate and direction only, for footprints: `pixel` is clamped to the map.
Hits fetch_escape(ivec2 pixel) {
    return in_world(unpacked_hits(texelFetch(hits0, place_in_map(pixel), 0), vec4(0.0), vec4(0.0)));
}

Hits fetch_hits(ivec2 pixel) {
    ivec2 place = place_in_map(pixel);
    vec4 t1 = vec4(0.0), t2 = vec4(0.0);
#if ORDERS > 0
    t1 = texelFetch(hits1, place, 0);
#endif
#if ORDERS > 1
    t2 = texelFetch(hits2, place, 0);
#endif
    return in_world(unpacked_hits(texelFetch(hits0, place, 0), t1, t2));
}

#if ORDERS > 0
// Relative drift of what the ray's model conserves, −1 where nothing was measured: only kept for the view that shows it.
float fetch_drift(ivec2 pixel) {
    return texelFetch(hits1, place_in_map(pixel), 0).w;
}
#endif
