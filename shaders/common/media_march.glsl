// What a ray finds on its way through media and between them, and how far it may step there. For transfer.frag, which has the contracts of media and says what GRID and SAMPLES are.

const int MOST_STEPS_ON = 8192, MOST_VISITS = 256, MOST_TRIES = 24;
#if SAMPLES
const float LEAST_PASSED = 1e-4;       // a pattern may leave gaps
#else
const float LEAST_PASSED = 1.0 / 512.0;
#endif
const float MOST_DEPTH = 0.5;          // of a piece, as its ends see it
#if GRID
uniform float fine_share;              // of a medium's scale: how exactly its surface is found
#else
const float fine_share = 1e-3;
#endif
const float HORIZON_MARGIN = 2e-5;     // of its radius: where rays end that fall in
const float NEAR_HORIZON = 1.05, FREE_FALL = 0.1;  // and where they end farther out: in times of its radius, with nothing so near, in times of theirs. They turn without end

#if GRID
const bool ENDS_LIT = false;           // of pieces, where light is asked for
#else
const bool ENDS_LIT = true;
#endif

// Whether surfaces are to be found: in a coarse picture those of soft media are not seen.
const bool EDGED = GRID == 0
#each medium : || MEDIUM_$KEY_SOFT == 0
;

// A place on the ray.
struct Here {
    vec3 x, towards;     // r_s; to the camera
    float speed;         // r_s by the parameter of the march
    vec3 gains, loses;   // of light, by the parameter of the march
    float step, fine;    // r_s to go at most; and to be exact to at surfaces
    float edge;          // r_s to the nearest surface of a medium
    int within;          // which media it is in: a bit each
};

void add_place(inout Here here, inout int bit, float off, float scale) {
    here.within ^= off < 0.0 ? bit : 0;
    here.edge = min(here.edge, abs(off));
    here.fine = min(here.fine, fine_share * scale);
    // Up to another medium no farther than it is, though the ray may gain speed on the way: of Mino time that many r_s lead beyond all.
    here.step = min(here.step, off < 0.0 ? plan_medium_step * scale : off / (1.0 + off / length(here.x)) + fine_share * scale);
    bit = bit >= (1 << 30) ? 1 : 2 * bit;
}

void add_light(inout Here here, float off, Matter matter, float pattern, bool bolometric, float energy) {
    bool inside = off < 0.0 && matter.shift > 0.0;
    float way = inside ? pattern / matter.shift : 0.0, seen = matter.shift * energy;
    float power = seen * seen * seen * (bolometric ? seen : 1.0);
    here.gains += inside ? way * power * matter.emission : vec3(0.0);
    here.loses += inside ? way * matter.absorption : vec3(0.0);
}

// Radius of the hole, r_s, as far as rays are followed.
float inner_radius() {
    return 0.5 * hole_w_factors.x * min(hole_horizon_size, 1.0);
}

// What moves and changes is, from here on, as it was when light left so late a place.
#if RAYS_LIGHT_TRAVEL
#define LOOK_BACK(delay) look_back(delay)
#else
#define LOOK_BACK(delay)
#endif

// `end`: the opaque thing that the ray ends on; far away where there is none. Where it is not `lit`, `loses` is what it loses on the piece before.
Here here_at(Orbit orbit, State s, Sight first, vec3 end, vec3 left, const bool lit, vec3 loses) {
    Path path = ray_path(orbit, s);
    LOOK_BACK(path_delay(path));
    Here here;
    here.x = path_point(path);
    vec3 velocity = path_velocity(path);
    here.speed = length(velocity);
    here.towards = -velocity / here.speed;
    here.gains = vec3(0.0);
    here.loses = lit ? vec3(0.0) : loses;
    here.step = here.fine = here.edge = 1e30;
    here.within = 0;
    int bit = 1;
#each medium : for (int i = 0; i < medium_$key_count; ++i) add_place(here, bit, medium_$key_distance(i, here.x), medium_$key_scale(i, here.x));
    if (lit) {
        Sight sight = Sight(here.x, here.towards, first.energy, first.beaming, true, -1, ray_momentum(orbit, s), first.right, first.up);
        float footprint = max(length(sight.right), length(sight.up));
#each medium : for (int i = 0; i < medium_$key_count; ++i) add_light(here, medium_$key_distance(i, here.x), medium_$key_matter(i, sight), SAMPLES == 1 ? 1.0 : medium_$key_pattern(i, here.x, footprint), MEDIUM_$KEY_BOLOMETRIC == 1, sight.beaming);
        float rate = ray_affine_rate(orbit, s);
        here.gains *= rate;
        here.loses *= rate;
    }
    // The way bends and clocks change with the radius, and near the horizon with the height above it.
    float r = length(here.x), most = plan_medium_step * r;
    // Of the radius alone: beside the horizon of a hole that spins a way turns without end.
    float inwards = max(abs(dot(here.towards, here.x)) / r, 1e-6);
    if (here.within != 0) most = min(most, plan_medium_step * max(r - inner_radius(), HORIZON_MARGIN * inner_radius()) / inwards);
    vec3 depth = mix(vec3(0.0), here.loses / here.speed, greaterThan(left, vec3(LEAST_PASSED)));
    most = min(most, MOST_DEPTH / max(max(max(depth.x, depth.y), depth.z), 1e-20));
    here.step = min(min(here.step, most), max(distance(here.x, end), here.fine));
    return here;
}

// Of a piece: the share of what it gains that gets out of it, and what comes through it.
struct Passage {
    vec3 share, passed;
};

// Of `way` long, in the parameter of the march, through matter that loses so much.
Passage passage_of(vec3 loses, float way) {
    vec3 depth = loses * way, passed = exp(-depth), share = (1.0 - passed) / max(depth, vec3(1e-20));
    vec3 series = 1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0 - depth / 120.0)));
    return Passage(mix(share, series, lessThan(depth, vec3(0.2))), passed);
}

// Light after it, where it gains so much.
Light after_piece(Light light, Passage piece, vec3 gains) {
    return Light(light.gathered + light.passed * piece.share * gains, light.passed * piece.passed);
}

void add_edged(inout int edged, inout int bit, const bool soft) {
    edged |= soft ? 0 : bit;
    bit = bit >= (1 << 30) ? 1 : 2 * bit;
}

// Which media end at an edge that is seen, as Here tells them.
int edged_media() {
    int edged = 0, bit = 1;
#each medium : for (int i = 0; i < medium_$key_count; ++i) add_edged(edged, bit, MEDIUM_$KEY_SOFT == 1);
    return edged;
}

// Signed distance of the nearest medium, and how exactly surfaces there are to be found, r_s.
vec2 room_at(vec3 x) {
    vec2 room = vec2(1e30);
#each medium : for (int i = 0; i < medium_$key_count; ++i) room = min(room, vec2(medium_$key_distance(i, x), fine_share * (EDGED ? medium_$key_scale(i, x) : length(x))));
    return room;
}

void look_within(inout int within, inout int bit, inout float edge, float off) {
    within ^= off < 0.0 ? bit : 0;
    edge = min(edge, abs(off));
    bit = bit >= (1 << 30) ? 1 : 2 * bit;
}

// Which media x is in, as Here tells it, and how far the nearest surface is.
int within_at(vec3 x, out float edge) {
    int within = 0, bit = 1;
    edge = 1e30;
#each medium : for (int i = 0; i < medium_$key_count; ++i) look_within(within, bit, edge, medium_$key_distance(i, x));
    return within;
}

// Whether a ray has nothing before it any more: it has left all for good, come to its `end` or to the horizon.
bool is_over(Orbit orbit, State s, Here here, vec3 end) {
    float r = length(here.x);
    bool gone = !is_finite(here.x) || ray_fate(orbit, s) == ESCAPED || r > meeting_reach && dot(here.x, here.towards) < 0.0;
    return gone || distance(here.x, end) <= here.fine || r < (1.0 + HORIZON_MARGIN) * inner_radius();
}

#if ORDERS > 0
// Whether a piece whose ends are so high above the disk's plane, the second at y, crosses it where crossings count.
bool crosses_plane(vec2 heights, vec3 y) {
    return (heights.x < 0.0) != (heights.y < 0.0) && length(y) > crossing_r_min;
}

// Whether a crossing at y may be one of the disk's, or a neighbour's is.
bool is_near_disk(vec3 y) {
    return length(y) < 1.5 * disk_r_out;
}
#endif

// The first step of a parallel ray, in Mino time, from the direction n, where no place has numbers: to twice as far as all that may be met, or less near.
void come_from_infinity(Orbit orbit, inout State s, vec3 n, inout int stretch, inout bool meets_disk) {
    s = march_step(orbit, s, min(ray_plain_step(orbit, s), 0.25 / meeting_reach));
#if ORDERS > 0
    vec3 x = path_point(ray_path(orbit, s));
    bool crosses = crosses_plane(vec2(disk_height(n), disk_height(x)), x);
    stretch = crosses ? min(stretch + 1, ORDERS) : stretch;
    meets_disk = meets_disk || crosses && is_near_disk(x);
#endif
}

// On through empty space, to where the next step, no longer than it is to the nearest medium, leads into one, or to where the ray is over. Steps go farther than that
// where what is known at both ends says that nothing lies between (Keinert et al. 2014): most of all where the ray goes away from what is nearest. They are of the parameter
// of the march, by the speed that the ray has where they begin: outwards it may gain so much that one leads beyond all media, and is taken anew, as much shorter.
void cross_gap(Orbit orbit, inout State s, inout Here here, vec3 end, inout int stretch, inout bool meets_disk, inout bool over) {
    bool outside = here.within == 0;
    float farther = 0.0, share = 1.0;
    for (int i = 0; i < MOST_STEPS_ON; ++i) {
        if (!outside || over) break;
        float close = here.edge + here.fine;
        float most = min(plan_medium_step * length(here.x), max(distance(here.x, end), here.fine));
        here.step = share * min(close, most);
        float h = min(max(min(farther, most), here.step) / here.speed, ray_plain_step(orbit, s));
        State next = march_step(orbit, s, h);
        Path path = ray_path(orbit, next);
        vec3 x = path_point(path), velocity = path_velocity(path);
        LOOK_BACK(path_delay(path));
        vec2 room = room_at(x);
        float chord = distance(x, here.x);
        bool unsure = chord > 1.05 * close && here.edge + room.x < 1.05 * chord;
        outside = unsure || room.x >= 0.0;
        share = !unsure ? 1.0 : farther > close ? share : share * close / chord;
        farther = unsure ? 0.0 : 1.8 * room.x / max(1.0 - (room.x - here.edge) / max(chord, 1e-20), 0.1);
        if (outside && !unsure) {
#if ORDERS > 0
            bool crosses = crosses_plane(vec2(disk_height(here.x), disk_height(x)), x);
            stretch = crosses ? min(stretch + 1, ORDERS) : stretch;
            meets_disk = meets_disk || crosses && is_near_disk(x);
#endif
#ifdef RAY_RECHARTS
            next = ray_recharted(s, next);
#endif
            s = next;
            here.x = x;
            here.speed = length(velocity);
            here.towards = -velocity / here.speed;
            here.edge = room.x;
            here.fine = room.y;
            bool sinks = ray_fate(orbit, s) == CAPTURED && length(x) < NEAR_HORIZON * inner_radius() && room.x > FREE_FALL * length(x);
            over = sinks || is_over(orbit, s, here, end);
        }
    }
}

// A surface ahead: clear up to it, and the little that it lies in, in the parameter of the march. `within` 0: none is known of.
struct Surface {
    float clear, within;
};

// The first surface on the next step, if there is one: false position, on the curve that the step is.
Surface surface_ahead(Orbit orbit, State s, Here here) {
    float whole = min(here.step / here.speed, ray_plain_step(orbit, s)), fine = here.fine / here.speed, high = whole, t = high;
    State middle = march_step(orbit, s, 0.5 * whole), last = march_step(orbit, middle, 0.5 * whole);  // as light is gathered
    Way way = Way(ray_path(orbit, s), ray_path(orbit, middle), ray_path(orbit, last), whole);
    float clear = 0.0, before = here.edge, after = 0.0;
    for (int k = 0; k < MOST_TRIES; ++k) {
        float edge;
        Path at = way_path(way, t / whole);
        LOOK_BACK(path_delay(at));
        bool same = within_at(path_point(at), edge) == here.within;
        clear = same ? t : clear;
        before = same ? edge : before;
        high = same ? high : t;
        after = same ? after : edge;
        float root = mix(clear, high, before / max(before + after, 1e-20)), room = 0.02 * (high - clear);
        t = clamp(root - clear > fine ? root - 0.4 * fine : root + 0.4 * fine, clear + room, high - room);
        if (high - clear <= fine) break;
    }
    return Surface(clear, high - clear);
}
