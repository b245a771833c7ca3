// Writes hits into the targets of the trace pass. The other half is hit_map_read.glsl.
#include "common/finite.glsl"
#include "common/hit_texels.glsl"
#include "common/disk_plane.glsl"

layout(location = 0) out vec4 hits0_out;
#if ORDERS > 0
layout(location = 1) out vec4 hits1_out;
#endif
#if ORDERS > 1
layout(location = 2) out vec4 hits2_out;
#endif
// The targets after those.
#if ORDERS > 1
#define FREE_TARGET_0 3
#define FREE_TARGET_1 4
#define FREE_TARGET_2 5
#define FREE_TARGET_3 6
#define FREE_TARGET_4 7
#elif ORDERS == 1
#define FREE_TARGET_0 2
#define FREE_TARGET_1 3
#define FREE_TARGET_2 4
#define FREE_TARGET_3 5
#define FREE_TARGET_4 6
#else
#define FREE_TARGET_0 1
#define FREE_TARGET_1 2
#define FREE_TARGET_2 3
#define FREE_TARGET_3 4
#define FREE_TARGET_4 5
#endif
// NO_MEETINGS: of rays that look for no things or media, in a map of rays that do: as many as those keep.
#if MEETINGS || NO_MEETINGS
layout(location = FREE_TARGET_0) out vec4 met0_out;
layout(location = FREE_TARGET_1) out vec4 way0_out;
#endif
#if MEETINGS > 1 || NO_MEETINGS > 1
layout(location = FREE_TARGET_2) out vec4 met1_out;
layout(location = FREE_TARGET_3) out vec4 way1_out;
#endif
#if RAYS_LIGHT_TRAVEL
#if MEETINGS > 1 || NO_MEETINGS > 1
layout(location = FREE_TARGET_4) out vec4 times_out;
#elif MEETINGS || NO_MEETINGS
layout(location = FREE_TARGET_2) out vec4 times_out;
#else
layout(location = FREE_TARGET_0) out vec4 times_out;
#endif
#endif
// With two meetings, in a scene with media, there is no room for momenta.
#if RAYS_LISTED && MEETINGS < 2
#if MEETINGS == 1 && RAYS_LIGHT_TRAVEL
layout(location = FREE_TARGET_3) out vec4 momenta0_out;
layout(location = FREE_TARGET_4) out vec4 momenta1_out;
#elif MEETINGS == 1
layout(location = FREE_TARGET_2) out vec4 momenta0_out;
layout(location = FREE_TARGET_3) out vec4 momenta1_out;
#elif RAYS_LIGHT_TRAVEL
layout(location = FREE_TARGET_1) out vec4 momenta0_out;
layout(location = FREE_TARGET_2) out vec4 momenta1_out;
#else
layout(location = FREE_TARGET_0) out vec4 momenta0_out;
layout(location = FREE_TARGET_1) out vec4 momenta1_out;
#endif
#endif

#if POST_VIEW_CONSERVATION
float march_drift = -1.0;  // relative drift of what the ray's model conserves; −1: nothing measured
#endif

// Hits with every number finite: what is not becomes an unresolved ray.
Hits only_finite(Hits hits) {
    bool plane = is_finite(vec3(hits.crossing[0], hits.lambda)) && is_finite(vec3(hits.crossing[1], 0.0)) && is_finite(vec3(hits.crossing[2], 0.0));
    bool space = true;
#if RAYS_LIGHT_TRAVEL
    space = is_finite(hits.delay);
#endif
#if MEETINGS
    for (int k = 0; k < MEETINGS; ++k)
        space = space && is_finite(hits.meeting[k].place) && is_finite(hits.meeting[k].momentum.n_rate) && is_finite(vec3(hits.meeting[k].momentum.w_rate));
#endif
    if (plane && space && is_finite(hits.direction)) return hits;
    Hits failed = no_hits(0.0);
    failed.steps = hits.steps;
    return failed;
}

#if RAYS_LISTED && MEETINGS < 2
// (k_r, k_θ) in the disk's plane at `point`; zero without a crossing.
vec2 covariant_momentum(vec2 point, Momentum momentum) {
    if (point == vec2(0.0)) return vec2(0.0);
#if SPACE_TIME_FLAT
    float fall = 1.0;
#else
    float w = 0.5 * inversesqrt(dot(point, point));
    float fall = (1.0 - w * hole_w_factors.x) * (1.0 - w * hole_w_factors.y);
#endif
#if DISK_TILTED
    return vec2(momentum.w_rate / fall, momentum.n_rate.z / max(length(normalize(disk_place(point)).xy), 1e-6));
#else
    return vec2(momentum.w_rate / fall, momentum.n_rate.z);
#endif
}
#endif

void store_hits(Hits traced) {
    Hits hits = only_finite(traced);
    hits0_out = escape_texel(note_of(hits), hits.fate, hits.steps);
#if ORDERS > 0
#if POST_VIEW_CONSERVATION
    float rest = is_finite(vec3(march_drift)) ? march_drift : 1.0;
#else
    float rest = float(hits.inbound);
#endif
    hits1_out = first_texel(hits.crossing[0], hits.lambda, rest);
#endif
#if ORDERS > 1
    hits2_out = others_texel(hits.crossing[1], ORDERS > 2 ? hits.crossing[2] : vec2(0.0));
#endif
#if MEETINGS
    met0_out = met_texel(hits.meeting[0]);
    way0_out = way_texel(hits.meeting[0]);
#endif
#if MEETINGS > 1
    met1_out = met_texel(hits.meeting[1]);
    way1_out = way_texel(hits.meeting[1]);
#endif
#if NO_MEETINGS
    met0_out = way0_out = vec4(0.0);
#endif
#if NO_MEETINGS > 1
    met1_out = way1_out = vec4(0.0);
#endif
#if RAYS_LIGHT_TRAVEL
    times_out = times_texel(hits);
#endif
#if RAYS_LISTED && MEETINGS < 2
    momenta0_out = vec4(covariant_momentum(hits.crossing[0], hits.momentum[0]), covariant_momentum(hits.crossing[1], hits.momentum[1]));
    momenta1_out = vec4(covariant_momentum(hits.crossing[2], hits.momentum[2]), vec2(0.0));
#endif
}
