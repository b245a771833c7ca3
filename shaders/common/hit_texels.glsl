// How hits lie in texels: the one place that knows. On the host, blackhole_gl/rendering/hit_texels.py.
//
//   hits0   direction, 4·steps + fate; with one of MEETINGS the note of what ends the ray in place of the direction
//   hits1   crossing 0, λ, inbound (for the view of conserved quantities the drift)  with ORDERS > 0
//   hits2   crossings 1 and 2                                                       with ORDERS > 1
//   met0, way0, …   place in r_s and what is met there; w_rate and n_rate of the momentum      a pair for each of MEETINGS
//   times   delays of crossings 0 and 1, of crossing 2 or with two meetings of the second, of the first meeting    with RAYS_LIGHT_TRAVEL
//   momenta0, momenta1   (k_r, k_θ) at crossings 0 and 1, and at crossing 2         of listed rays alone

vec4 escape_texel(vec3 direction, int fate, int steps) {
    return vec4(direction, float(4 * steps + fate));
}

// `rest`: `inbound`, or the drift.
vec4 first_texel(vec2 crossing, float lambda, float rest) {
    return vec4(crossing, lambda, rest);
}

vec4 others_texel(vec2 second, vec2 third) {
    return vec4(second, third);
}

int texel_fate(vec4 t0) {
    return int(t0.w + 0.5) & 3;
}

float texel_steps(vec4 t0) {
    return floor(0.25 * t0.w);
}

// The hits in the texels of the three textures; those of textures that are not there are vec4(0).
Hits unpacked_hits(vec4 t0, vec4 t1, vec4 t2) {
    Hits hits = no_hits(t1.z);
    hits.fate = texel_fate(t0);
    hits.direction = hits.fate == ESCAPED ? t0.xyz : vec3(0.0);
    hits.steps = int(t0.w + 0.5) >> 2;
    hits.crossing = vec2[3](t1.xy, t2.xy, t2.zw);
#if !POST_VIEW_CONSERVATION
    hits.inbound = int(t1.w + 0.5);
#endif
    return hits;
}

// What stands in place of the direction of a ray that ends on a thing.
vec3 note_of(Hits hits) {
#if MEETINGS == 1
    if (hits.fate == MET) return hits.meeting[0].note;
#endif
    return hits.direction;
}

#if MEETINGS
// 24 bits, which a float holds: instance, sense, crossings before, kind and one, so that zero is none.
vec4 met_texel(Meeting meeting) {
    int bits = ((meeting.index * 2 + (meeting.enters ? 1 : 0)) * 4 + meeting.before) * 32 + meeting.kind + 1;
    return meeting.kind < 0 ? vec4(0.0) : vec4(meeting.place, float(bits));
}

vec4 way_texel(Meeting meeting) {
    return vec4(meeting.momentum.n_rate, meeting.momentum.w_rate);
}

Meeting unpacked_meeting(vec4 met, vec4 way, vec3 note AND_TIME(float delay)) {
    int bits = int(met.w + 0.5);
    return Meeting((bits & 31) - 1, bits >> 8, (bits >> 5) & 3, ((bits >> 7) & 1) == 1, met.xyz, Momentum(way.w, way.xyz), note AND_TIME(delay));
}
#endif

#if RAYS_LIGHT_TRAVEL
vec4 times_texel(Hits hits) {
    vec4 times = vec4(hits.delay, 0.0);
#if MEETINGS
    times.w = hits.meeting[0].delay;
#endif
#if MEETINGS > 1
    times.z = hits.meeting[1].delay;
#endif
    return times;
}
#endif
