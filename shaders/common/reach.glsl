// How near a coarse ray comes to balls in space, told by how far apart the rays beside it would have to end to meet one of them.
//
// Rays of the coarse grid one step apart are, after a way s, no farther from each other than
//     apart + spread·s         as straight lines from the camera, plus
//     Δ·l                      once the hole has bent them apart: Δ the angle between the directions in which they end, l the way since they came near it
// (docs/performance.md). Δ is not known before rays have ended; so a ray keeps the least Δ with which that reaches a ball, and reach_cells.frag compares.

uniform sampler2D reach_balls;  // a texel each: centre and radius in r_s, in the plan's frame
uniform int reach_count;

const int REACH_CHORDS = 4;       // straight pieces that a step is cut into
const float REACH_FAR_END = 1e-3; // of a step that begins or ends infinitely far away, left out there: nothing is out there
const float REACH_NEAR_HOLE = 6.0; // r_s, for gravity of strength 1: where the hole begins to bend rays apart
const float REACH_NEVER = 3.0;    // more than any two unit vectors are apart
const float REACH_CAPTURED = 1.1; // horizon radii at which the end of a captured ray is taken

struct Reach {
    vec3 x, v;       // place in r_s; unit vector along the way there
    float way;       // from where it began
    float bent;      // of it, since it came near the hole
    bool near_hole;
    float apart, spread;
    float least;     // Δ
    vec3 captured;   // direction from the hole where it went in
};

vec3 reach_point(Curve curve, float t, out vec3 velocity) {
    vec4 rate, place = curve_place(curve, t, rate);
    vec3 x = place.xyz / place.w;
    velocity = (rate.xyz - x * rate.w) / place.w;
    return x;
}

vec3 across(vec3 d, vec3 v) {
    return d - dot(d, v) * v;
}

// Of a ray whose first step is `curve`. To be called by all rays alike: it looks at those beside this one.
Reach reach_start(Curve curve) {
    Reach reach;
    vec3 velocity;
    reach.x = reach_point(curve, curve.a.place.w <= 0.0 ? REACH_FAR_END : 0.0, velocity);
    reach.v = normalize(velocity);
    reach.apart = max(length(across(dFdx(reach.x), reach.v)), length(across(dFdy(reach.x), reach.v)));
    reach.spread = curve.a.place.w <= 0.0 ? 0.0 : max(length(dFdx(reach.v)), length(dFdy(reach.v)));
    reach.way = reach.bent = 0.0;
    reach.near_hole = false;
    reach.least = REACH_NEVER;
    reach.captured = vec3(0.0);
    return reach;
}

// The least Δ that reaches a ball from the chord of length `size` along the unit vector `along` from reach.x; the way bulges from it by at most `bulge`.
float reach_of_chord(Reach reach, vec3 along, float size, float bulge) {
    float least = REACH_NEVER;
    for (int i = 0; i < reach_count; ++i) {
        vec4 ball = texelFetch(reach_balls, ivec2(i, 0), 0);
        float nearest = clamp(dot(ball.xyz - reach.x, along), 0.0, size);
        float gone = nearest + ball.w; // to the ball's far side
        float gap = distance(reach.x + nearest * along, ball.xyz) - ball.w - bulge - reach.apart - reach.spread * (reach.way + gone);
        float needed = reach.near_hole ? gap / (reach.bent + gone) : REACH_NEVER;
        least = min(least, gap <= 0.0 ? 0.0 : needed);
    }
    return least;
}

// One more step, as far as the part `end` of it.
void reach_step(Curve curve, float end, inout Reach reach) {
    float first = curve.a.place.w <= 0.0 ? REACH_FAR_END : 0.0, last = end < 1.0 ? end * (1.0 - REACH_FAR_END) : 1.0;
    vec3 from_velocity, to_velocity;
    reach.x = reach_point(curve, first, from_velocity);
    float near_hole = REACH_NEAR_HOLE * hole_gravity_strength, captured = 0.5 * REACH_CAPTURED * hole_w_factors.x;
    for (int k = 1; k <= REACH_CHORDS; ++k) {
        float share = (last - first) / float(REACH_CHORDS);
        vec3 to = reach_point(curve, first + float(k) * share, to_velocity);
        float size = distance(reach.x, to), from_r = length(reach.x), to_r = length(to);
        float bulge = 0.2 * share * length(to_velocity - from_velocity);
        reach.near_hole = reach.near_hole || to_r < near_hole || dot(to, to_velocity) > 0.0;
        reach.least = min(reach.least, reach_of_chord(reach, (to - reach.x) / max(size, 1e-20), size, bulge));
        if (from_r > captured && to_r <= captured) reach.captured = normalize(mix(reach.x, to, (from_r - captured) / (from_r - to_r)));
        reach.way += size;
        reach.bent += reach.near_hole ? size : 0.0;
        reach.x = to;
        from_velocity = to_velocity;
    }
}
