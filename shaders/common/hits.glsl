// What became of a ray. Directions stay vectors and crossings stay points: no angle is ever stored. How it lies in texels: hit_texels.glsl.

// What there is of times where light takes some (rays.light_travel): AND_TIME(x) stands for one more argument or member, or for none.
// All of it stands on one line: of a macro's arguments on two Mesa counts one, and a mistake below would be told one line too high.
#if RAYS_LIGHT_TRAVEL
#define AND_TIME(t) , t
#else
#define AND_TIME(t)
#endif

// Momentum of a ray as its model carries it: rates in Mino time (M = 1) along the ray traced backwards, |E| = 1, in the plan's frame.
// At the place w = M/r with the unit vector n from the hole, the photon that arrives has, covariant in Boyer–Lindquist's coordinates,
// k_r = w_rate/(Δw²), k_θ = −n_rate·e_θ, k_φ = λE = −sin θ n_rate·e_φ (docs/physics.md).
struct Momentum {
    float w_rate;
    vec3 n_rate;  // at right angles to n
};

// That of a ray at x in r_s that moves by v = dx/dσ, with the affine parameter σ scaled so that E = 1, where space is flat or Schwarzschild's.
Momentum momentum_at(vec3 x, vec3 v) {
    float r = length(x);
    vec3 n = x / r;
    float outward = dot(v, n);
    return Momentum(-outward, 2.0 * r * (v - outward * n));
}

#if MEETINGS
// With a thing or a medium.
struct Meeting {
    int kind, index;    // THING_… or MEDIUM_…, and which of its instances; MEETING_NONE
    int before;         // how many crossings of the disk's plane come before it along the ray
    bool enters;        // from outside into it
    vec3 place;         // r_s
    Momentum momentum;
    vec3 note;          // of what has parts (tells_apart) and ends the ray: 1 + the number of the part that is met, along its normal; else zero
#if RAYS_LIGHT_TRAVEL
    float delay;        // as Hits has it
#endif
};
#endif

#if MEETINGS
const Meeting NO_MEETING = Meeting(-1, 0, 0, false, vec3(0.0), Momentum(0.0, vec3(0.0)), vec3(0.0) AND_TIME(0.0));
#endif

struct Hits {
    int fate;          // UNRESOLVED, ESCAPED, CAPTURED, MET (something opaque)
    vec3 direction;    // asymptotic, world, unit; zero unless escaped
    float lambda;      // L_z/E in M
    int steps;
    vec2 crossing[3];  // r·(cos φ, sin φ) in r_s of the crossings of the disk's plane, in its axes, nearest along the ray first; zero = none
    int inbound;       // bit n: at crossing n the light still comes in towards the hole; of a tilted disk instead, it goes south there: k_θ > 0
#if RAYS_LIGHT_TRAVEL
    vec3 delay;        // r_s/c from each crossing to the camera; to one at infinity, less r + ln r of the camera in r_s
#endif
#if RAYS_LISTED
    Momentum momentum[3];  // at the crossings
#endif
#if MEETINGS
    Meeting meeting[MEETINGS];  // the first, nearest along the ray first
#endif
};

Hits no_hits(float lambda) {
    Hits hits;
    hits.fate = UNRESOLVED;
    hits.direction = vec3(0.0);
    hits.lambda = lambda;
    hits.steps = 0;
    hits.crossing = vec2[3](vec2(0.0), vec2(0.0), vec2(0.0));
    hits.inbound = 0;
#if RAYS_LIGHT_TRAVEL
    hits.delay = vec3(0.0);
#endif
#if RAYS_LISTED
    Momentum none = Momentum(0.0, vec3(0.0));
    hits.momentum = Momentum[3](none, none, none);
#endif
#if MEETINGS
    for (int k = 0; k < MEETINGS; ++k)
        hits.meeting[k] = NO_MEETING;
#endif
    return hits;
}

bool is_inbound(Hits hits, int n) {
    return (hits.inbound >> n & 1) == 1;
}

// Puts a crossing into the first free place; those beyond ORDERS are dropped.
void add_crossing(inout Hits hits, vec2 point, Momentum momentum AND_TIME(float delay)) {
    int place = hits.crossing[0] == vec2(0.0) ? 0 : hits.crossing[1] == vec2(0.0) ? 1 : hits.crossing[2] == vec2(0.0) ? 2 : 3;
    if (place == 0) hits.crossing[0] = point;
    else if (place == 1) hits.crossing[1] = point;
    else if (place == 2) hits.crossing[2] = point;
#if DISK_TILTED
    bool inbound = momentum.n_rate.z > 0.0;
#else
    bool inbound = momentum.w_rate < 0.0;
#endif
    if (inbound && place < 3) hits.inbound |= 1 << place;
#if RAYS_LIGHT_TRAVEL
    if (place < 3) hits.delay[place] = delay;
#endif
#if RAYS_LISTED
    if (place == 0) hits.momentum[0] = momentum;
    else if (place == 1) hits.momentum[1] = momentum;
    else if (place == 2) hits.momentum[2] = momentum;
#endif
}

#if MEETINGS
// Puts a meeting behind the others. Where there is no room those beyond are dropped, but not one that ends the ray: it takes the last place.
void add_meeting(inout Hits hits, int kind, int index, bool enters, vec3 place, Momentum momentum, vec3 note AND_TIME(float delay), bool ends) {
    int before = (hits.crossing[0] != vec2(0.0) ? 1 : 0) + (hits.crossing[1] != vec2(0.0) ? 1 : 0) + (hits.crossing[2] != vec2(0.0) ? 1 : 0);
    Meeting meeting = Meeting(kind, index, before, enters, place, momentum, note AND_TIME(delay));
    bool kept = false;
    for (int k = 0; k < MEETINGS; ++k) {
        if (!kept && (hits.meeting[k].kind < 0 || ends && k == MEETINGS - 1)) {
            hits.meeting[k] = meeting;
            kept = true;
        }
    }
}
#endif
