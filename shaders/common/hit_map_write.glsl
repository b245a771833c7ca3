// Writes hits into the targets of the trace pass. The other half is hit_map_read.glsl.

layout(location = 0) out vec4 hits0_out;  // direction, 4·steps + fate
#if ORDERS > 0
layout(location = 1) out vec4 hits1_out;  // crossing 0, λ, drift (for the view of conserved quantities; else 0)
#endif
#if ORDERS > 1
layout(location = 2) out vec4 hits2_out;  // crossings 1 and 2
#endif

#if POST_VIEW_CONSERVATION
float march_drift = -1.0;  // relative drift of what the ray's model conserves; −1: nothing measured
#endif

// Looks at the bits: compilers take liberties with comparisons of what is no number, Mesa's among them.
bool is_finite(vec3 v) {
    return all(notEqual(floatBitsToUint(v) & uvec3(0x7f800000u), uvec3(0x7f800000u)));
}

// Hits with every number finite: what is not becomes an unresolved ray.
Hits only_finite(Hits hits) {
    bool plane = is_finite(vec3(hits.crossing[0], hits.lambda)) && is_finite(vec3(hits.crossing[1], 0.0)) && is_finite(vec3(hits.crossing[2], 0.0));
    if (plane && is_finite(hits.direction)) return hits;
    Hits failed = no_hits(0.0);
    failed.steps = hits.steps;
    return failed;
}

void store_hits(Hits traced) {
    Hits hits = only_finite(traced);
    hits0_out = vec4(hits.direction, float(4 * hits.steps + hits.fate));
#if ORDERS > 0
    hits1_out = vec4(hits.crossing[0], hits.lambda, 0.0);
#if POST_VIEW_CONSERVATION
    hits1_out.w = is_finite(vec3(march_drift)) ? march_drift : 1.0;
#endif
#endif
#if ORDERS > 1
    hits2_out = vec4(hits.crossing[1], ORDERS > 2 ? hits.crossing[2] : vec2(0.0));
#endif
}
