// Marches a differential ray model: steps until the ray has escaped or is captured, and finds its crossings of the disk's plane on the way.
//
// A differential model (shaders/ray_models/) gives
//     struct Orbit                                constants of this ray
//     struct State                                what the integrator moves
//     Orbit ray_orbit(RayStart)
//     State ray_init(RayStart, Orbit, inout Hits) may add crossings that lie before the march, and set hits.fate to MET where the ray ends there
//     State ray_rhs(Orbit, State)                 the State's rate
//     State state_step(State s, float h, State k) s + h k
//     int   ray_fate(Orbit, State)                UNRESOLVED while under way
//     float ray_end(Orbit, State a, State b, float h)  fraction 0…1 of the last step at which the ray ends
//     void  ray_finish(Orbit, State, inout Hits)  from the end of the march to infinity; may set hits.fate to MET
//     float ray_height(State), ray_height_rate(State)  of the sign of z
//     vec2  ray_plane_point(State)                r·(cos φ, sin φ) in r_s
//     Path  ray_path(Orbit, State)                where it is in space, with rates (common/curve.glsl)
//     Momentum ray_momentum(Orbit, State)         (common/hits.glsl)
//     float ray_affine_rate(Orbit, State)         ds/dσ: affine length in r_s, of a photon with E = 1, by the parameter of the march; its length where space is flat
// With RAYS_LIGHT_TRAVEL, of a model whose header says tells_time,
//     float ray_delay(State)                      time of light from there to the camera, as Hits has it; ray_delay_rate(Orbit, State): by the march's parameter
//     State ray_delayed(State, float)             the same state, with so much more of it
// and, for those integrators and step controls that ask for them,
//     State state_kick(State s, float h, State k), state_drift(State s, float h)   what only places drive moved by h k; places moved by their rates
//     State state_push(State s, float h2, State k)      places moved by h2 times the rates of their rates
//     float state_difference(Orbit, State a, State b)   about the angle in radians by which two ends of one step differ
//     float ray_plain_step(Orbit, State), ray_longest_step(Orbit, State)   the step before any control; the longest in which nothing is missed
//     float ray_radius(State), ray_elevation(State)     in r_s; sine of the angle above z = 0
// RAY_RECHARTS: State ray_recharted(State a, State b)  `b`, or the same place in coordinates that suit the way from `a` better.
// RAY_FIRST_ORDER: places are not moved by rates of their own: there is no state_drift and no state_push.
// RAY_QUADRATURE: names a function (Orbit, State a, float h, inout State b) that completes what follows from a step but drives nothing.
// RAY_SCALED_STEP: names a function float (Orbit, State), the plain step by how fast what bends the ray changes there, for step controls that ask for it.
// RAY_MEETS_BEYOND: ray_init and ray_finish also meet what lies before and after the march, and begin at the camera.
// RAY_STEPS_SHORT: many steps pass the same thing, so that it pays to remember how far things are from the last that was looked at.
// RAY_DRIFT: names a function float (Orbit, State)   how far a quantity that should stay is from where it should be, relative to its
// size; −1 for none. For the view of conserved quantities only.
//
// A step control gives step_size(Orbit, State), or with STEP_ADAPTS
//     State adapted_step(Orbit, State s, inout float trial, out float h)   one step of length h ≤ trial; rejected: s itself, with h = 0
// An integrator gives integrator_step(Orbit, State, float h), one with an error estimate also integrator_pair and INTEGRATOR_ERROR_POWER.

#include "common/march_step.glsl"
#include "common/disk_plane.glsl"

#if RAYS_LIGHT_TRAVEL
#define AND_DELAY(state) , ray_delay(state)
#else
#define AND_DELAY(state)
#endif

#if ORDERS > 0
// Of the sign of the height above the disk's plane, and its rate.
vec2 plane_height(Orbit orbit, State s) {
#if DISK_TILTED
    Path path = ray_path(orbit, s);
    vec2 turn = cos_sin(path.twist.x);
    vec3 n = vec3(rotate(path.place.xy, turn), path.place.z);
    vec3 rate = vec3(rotate(path.rate.xy, turn) + path.twist.y * vec2(-n.y, n.x), path.rate.z);
    return vec2(disk_height(n), disk_height(rate));
#else
    return vec2(ray_height(s), ray_height_rate(s));
#endif
}

// The side of the plane that a ray is on; in the plane, the one it heads for, so that the camera's own place there does not count.
bool is_below(Orbit orbit, State s) {
    vec2 height = plane_height(orbit, s);
    return height.x < 0.0 || (height.x == 0.0 && height.y < 0.0);
}

// The part of a step of `h` at which it crosses the plane, by the cubic Hermite polynomial.
float crossing_part(Orbit orbit, State a, State b, float h) {
    vec2 before = plane_height(orbit, a), after = plane_height(orbit, b);
    return hermite_root(before.x, h * before.y, after.x, h * after.y);
}

// One crossing between `a` and the state a step of `h` later. The root found on the cubic Hermite polynomial is stepped to again,
// so that the crossing is as accurate as the march and not as the polynomial.
void find_crossing(Orbit orbit, State a, State b, float h, float end, inout Hits hits) {
    float t = crossing_part(orbit, a, b, h);
    if (t >= end) return;
    State there = march_step(orbit, a, h * t);
    vec2 height = plane_height(orbit, there);
#if DISK_TILTED
    // Where the frame is dragged, the height above a tilted plane is no cubic: Newton's method, or halving where that leaves what holds the crossing.
    float low = 0.0, high = 1.0, side = is_below(orbit, a) ? -1.0 : 1.0;
    for (int i = 0; i < 6; ++i) {
        if (side * height.x > 0.0) low = t;
        else high = t;
        float next = t - height.x / (h * height.y);
        t = next >= low && next <= high ? next : 0.5 * (low + high);
        there = march_step(orbit, a, h * t);
        height = plane_height(orbit, there);
    }
#endif
    float slip = clamp(-height.x / height.y, -0.1 * h, 0.1 * h);
#if RAYS_LIGHT_TRAVEL
    there = ray_delayed(there, slip * ray_delay_rate(orbit, there));
#endif
#ifdef RAY_FIRST_ORDER
    there = state_step(there, slip, ray_rhs(orbit, there));
#else
    there = state_drift(there, slip);
#endif
#if DISK_TILTED
    vec2 point = in_disk_axes(path_point(ray_path(orbit, there))).xy;
#else
    vec2 point = ray_plane_point(there);
#endif
    if (dot(point, point) > crossing_r_min * crossing_r_min) add_crossing(hits, point, ray_momentum(orbit, there) AND_DELAY(there));
}
#endif

#if MEETINGS
const int MOST_STEPS = 32767;
#ifdef RAY_STEPS_SHORT
const bool MARCH_REMEMBERS = true;
#else
const bool MARCH_REMEMBERS = false;  // by Kerr's six steps a ray it costs a tenth more
#endif
#endif

// A ray under way.
struct March {
    State s, next;  // before and after the last step
    float h;        // its length
#ifdef STEP_ADAPTS
    float trial;
#endif
    int steps, fate;
    bool crossed;   // the disk's plane, in the last step
#if MEETINGS
    int first;      // leaf that may have been met
    bool near;      // something may have been met in it
    vec4 clear;     // a ball in which nothing can be
#endif
#if !RAYS_EARLY_END
    float gone, whole;  // how far it has gone, in the parameter of the march, and would go by all steps
#endif
};

// A loop with one exit goes on for finished rays (docs/llvmpipe.md) and hands on what later rounds computed. Where the body is a function of
// the state alone that is the same, and saves copies of two states a round (docs/performance.md). A trial step or a change of chart is
// altered by the round itself: those loops get a second exit, which keeps every ray's own values.
#if defined(STEP_ADAPTS) || defined(RAY_RECHARTS)
#define MARCH_REPEATS 0
#else
#define MARCH_REPEATS 1
#endif

// Whether what happened in the last step is dear to look at.
bool march_pauses(March m) {
#if MEETINGS
    return m.crossed || m.near;
#else
    return m.crossed;
#endif
}

March march_start(Orbit orbit, State first) {
    March m;
    m.s = m.next = first;
    m.h = 0.0;
#ifdef STEP_ADAPTS
    m.trial = ray_plain_step(orbit, first);
#endif
    m.steps = 0;
    m.fate = UNRESOLVED;
    m.crossed = false;
#if MEETINGS
    m.near = false;
    m.first = 1;
    m.clear = NOWHERE;
#endif
#if !RAYS_EARLY_END
    m.gone = 0.0;
    m.whole = float(plan_max_steps) * ray_plain_step(orbit, first);
#endif
    return m;
}

#if DISK_TILTED
// Radians about the hole in a step, so that no two crossings of the plane lie in one; and of them those of a twist, whose quadrature says where a tilted plane is
// crossed, while in a level one it turns the crossing alone.
const float MOST_TURN = 0.7, MOST_TWIST = 0.3;
const float LEAST_PART = 1.0 / 16.0;  // of a step: at the horizon the turn has no end, and no light comes back

// A step of `h`, or a shorter one where a spinning hole turns the ray about its axis faster than it bends.
float step_within_turn(Orbit orbit, State s, float h) {
    Path path = ray_path(orbit, s);
    vec3 n = path.place.xyz, rate = path.rate.xyz + path.twist.y * vec3(-n.y, n.x, 0.0);
    float turn = length(cross(n, rate)) / dot(n, n);
    return h * clamp(MOST_TURN / max(abs(h) * turn, 1e-20), LEAST_PART, 1.0);
}
#endif

// One step, tried or taken.
void march_once(Orbit orbit, inout March m) {
#ifdef RAY_RECHARTS
    m.next = ray_recharted(m.s, m.next);
#endif
    m.s = m.next;
#ifdef STEP_ADAPTS
#if DISK_TILTED
    m.trial = step_within_turn(orbit, m.s, m.trial);
#endif
    m.next = adapted_step(orbit, m.s, m.trial, m.h);
    if (m.h != 0.0) m.next = completed(orbit, m.s, m.h, m.next);  // 0: refused, to be tried again shorter
#else
    m.h = step_size(orbit, m.s);
#if DISK_TILTED
    m.h = step_within_turn(orbit, m.s, m.h);
#endif
    m.next = march_step(orbit, m.s, m.h);
#endif
#if !RAYS_EARLY_END
    m.gone += m.h;
#endif
    ++m.steps;
    m.fate = ray_fate(orbit, m.next);
}

#if DISK_TILTED && ORDERS > 0
void shorten(Orbit orbit, float part, inout March m) {
    m.h *= part;
    m.next = march_step(orbit, m.s, m.h);
    m.fate = ray_fate(orbit, m.next);
}

// Takes a shorter last step where the twist has grown too fast in it; and ends it where the ray comes nearest to the plane, if it may have been beyond it there and is
// back on the side that it came from: light that is dragged about the axis may cross a tilted plane and turn.
void keep_to_plane(Orbit orbit, inout March m) {
    float turned = abs(ray_path(orbit, m.next).twist.x - ray_path(orbit, m.s).twist.x);
    if (!(turned <= MOST_TWIST)) shorten(orbit, turned < 1e6 ? max(MOST_TWIST / turned, LEAST_PART) : LEAST_PART, m);
    vec2 before = plane_height(orbit, m.s), after = plane_height(orbit, m.next);
    float side = is_below(orbit, m.s) ? -1.0 : 1.0, t = before.y / (before.y - after.y);
    bool returns = side * after.x > 0.0 && side * before.y < 0.0 && side * after.y > 0.0;
    float nearest = dot(hermite_weights(t), vec4(before.x, m.h * before.y, after.x, m.h * after.y));
    if (returns && side * nearest < 0.5 * min(abs(before.x), abs(after.x))) shorten(orbit, t, m);
}
#endif

// Steps until the ray ends or, where `seeks`, has crossed the disk's plane. It only steps: every branch of a loop's body runs (docs/llvmpipe.md) in
// every round, so what happens once a ray or once a crossing stands outside it.
void march_on(Orbit orbit, bool seeks, inout March m) {
#if MARCH_REPEATS
    do {
#else
    while (m.steps < plan_max_steps) {
#endif
        march_once(orbit, m);
#if ORDERS > 0
#if DISK_TILTED
        if (seeks) keep_to_plane(orbit, m);
#endif
        m.crossed = seeks && is_below(orbit, m.next) != is_below(orbit, m.s);
#endif
#if MEETINGS
#if RAYS_BOUNDS
        m.near = may_meet(ray_path(orbit, m.s), ray_path(orbit, m.next), m.h, MARCH_REMEMBERS, m.clear, m.first);
#else
        m.near = true;
#endif
#endif
#if MARCH_REPEATS
    } while (!march_pauses(m) && m.fate == UNRESOLVED && m.steps < plan_max_steps);
#else
        if (march_pauses(m) || m.fate != UNRESOLVED) break;
    }
#endif
}

#if MEETINGS
// The way of the last step, of one that falls in as far as the horizon: beyond it, where it turns without end, it is no cubic. A long step near the hole is one in
// halves only.
Way way_of(Orbit orbit, March m) {
    Path a = ray_path(orbit, m.s), b = ray_path(orbit, m.next);
    float h = m.h;
#if !IN_FIELD  // where there is no horizon
    if (m.fate == CAPTURED) {
        h *= part_outside(Curve(a, b, h), crossing_r_min * min(hole_horizon_size, 1.0));
        b = ray_path(orbit, march_step(orbit, m.s, h));
    }
#endif
    return Way(a, ray_path(orbit, march_step(orbit, m.s, 0.5 * h)), b, h);
}

const int MOST_TRIES = 5;
const float CLOSE = 0.003;  // of what is taken for straight: the rest of the way is no step of the march, and errs by its square

// One meeting within the step from `a` along `way`. As with crossings the place on the curve is stepped to again, and the rest is straight; where that is too long, as a
// long step leaves the curve by more than the march errs, it is stepped to once more. A round leaves what is done where it is (docs/llvmpipe.md).
void add_meeting_found(Orbit orbit, State a, Way way, Found found, inout Hits hits) {
    State there;
    float t = found.at, slip;
    bool farther = false, done;
    int tries = 0;
    do {
        there = march_step(orbit, a, way.h * t);
        Path path = ray_path(orbit, there);
        vec3 x = path_point(path), velocity = path_velocity(path);
#if RAYS_LIGHT_TRAVEL
        velocity -= earlier_by_delay(found.kind, found.index, ray_delay(there)) * ray_delay_rate(orbit, there);
#endif
        float speed = length(velocity), near = straight_reach(found.size, x);
        float beyond = beyond_surface(found, x, velocity / speed, farther ? max(0.3 * found.size, near) : near);
        bool known = beyond < 1e29, close = abs(beyond) < CLOSE * near;
        done = close || farther && !known || is_placed(found);
        slip = known ? beyond / speed : 0.0;
        float moved = clamp(t + slip / way.h, max(0.5 * t, way.a.place.w > 0.0 ? 0.0 : FAR_END), 1.0);  // never where a far ray begins, which is no place
        t = done ? t : moved;
        farther = done ? farther : !known;
    } while (!done && ++tries < MOST_TRIES);
#if RAYS_LIGHT_TRAVEL
    there = ray_delayed(there, slip * ray_delay_rate(orbit, there));
#endif
#ifdef RAY_FIRST_ORDER
    there = state_step(there, slip, ray_rhs(orbit, there));
#else
    there = state_drift(there, slip);
#endif
    vec3 place = path_point(ray_path(orbit, there));
#if BALLS_KNOWN
    if (is_placed(found)) place = found.place;
#endif
    meet(found, place, ray_momentum(orbit, there) AND_DELAY(there), hits);
}

// All that is met in a step, crossings of the disk's plane too, in order, the first thing or medium being `found`. Returns whether the ray ends on something opaque.
bool meet_in_step(Orbit orbit, March m, Way way, float end, Found found, inout Hits hits) {
    float crossing = 1e30;  // the part of the way
#if ORDERS > 0
    if (m.crossed) crossing = crossing_part(orbit, m.s, m.next, m.h) * m.h / way.h;
#endif
#if MEETINGS > 1
    for (int i = 0; i < 8; ++i) {
#endif
        bool none = found.kind == MEETING_NONE;
#if ORDERS > 0
        if (crossing < 1e29 && (none || crossing < found.at)) {
            find_crossing(orbit, m.s, m.next, m.h, end, hits);
            crossing = 1e30;
        }
#endif
        if (none) return false;
        add_meeting_found(orbit, m.s, way, found, hits);
        if (is_opaque(found.kind)) return true;
#if MEETINGS > 1
        Path path = way_path(way, found.at);
        float beyond = found.at + 2.0 * overstep(found.size, path_point(path)) / length(path_velocity(path));
        found = next_meeting(way, beyond, min(end, 1.0), m.first);
    }
#endif
    return false;
}
#endif

#if !RAYS_EARLY_END
// The steps of a ray that is marched on for as long a way as all steps would be at first, whatever has become of it; nobody sees what it meets there. What it
// finds is part of a comparison that is never true, or else the compiler would leave the march out.
int steps_gone_on(Orbit orbit, March m) {
    float found = 0.0;
    while (m.gone < m.whole && m.steps < plan_max_steps) {
        march_once(orbit, m);
#if MEETINGS
        bool near = true;
#if RAYS_BOUNDS
        near = may_meet(ray_path(orbit, m.s), ray_path(orbit, m.next), m.h, MARCH_REMEMBERS, m.clear, m.first);
#endif
        if (near) found += next_meeting(way_of(orbit, m), 0.0, 1.0, 1).at;
#endif
    }
    return m.steps + (abs(ray_height(m.next)) + found < -plan_step_length ? 1 : 0);
}
#endif

// Where in the last step the ray escapes: beyond it unless it does, as the very end of a step may be a crossing.
float march_end(Orbit orbit, March m) {
    return m.fate == ESCAPED ? ray_end(orbit, m.s, m.next, m.h) : 2.0;
}

// Whether the first thing that is found ends the ray, and nothing else is looked for: then what is done with it stands outside of all loops.
#if MEETINGS == 1 && ORDERS == 0
#define MEETS_ONCE 1
#else
#define MEETS_ONCE 0
#endif

Hits trace_ray(RayStart start) {
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    March m = march_start(orbit, ray_init(start, orbit, hits));
#if MEETINGS
    vec4 place = path_place(ray_path(orbit, m.s));
#ifndef RAY_MEETS_BEYOND
    if (place.w > 0.0) meet_at_start(place.xyz / place.w, ray_momentum(orbit, m.s), hits);
#endif
    // From step to step in which something may be met, and between them from crossing to crossing: what is dear to look at stands outside of the loop over these.
    bool met = hits.fate == MET;
    float end;
    Way way;
    Found found = NOTHING_FOUND;
    do {
        bool between;
#if MARCH_REPEATS
        do {
#else
        for (int i = 0; i < MOST_STEPS; ++i) {
#endif
            march_on(orbit, ORDERS > 0, m);
            end = march_end(orbit, m);
            between = m.crossed && !m.near;
#if ORDERS > 0
            if (between && !met) find_crossing(orbit, m.s, m.next, m.h, end, hits);
#endif
            between = between && m.fate == UNRESOLVED && m.steps < plan_max_steps;
#if MARCH_REPEATS
        } while (between);
#else
            if (!between) break;
        }
#endif
        way = way_of(orbit, m);
        found = NOTHING_FOUND;
        if (m.near) found = next_meeting(way, 0.0, min(end, 1.0), m.first);
#if MEETS_ONCE
        met = met || found.kind != MEETING_NONE;
#else
        if (m.near && !met) met = meet_in_step(orbit, m, way, end, found, hits);
#endif
    } while (!met && m.fate == UNRESOLVED && m.steps < plan_max_steps);
#if MEETS_ONCE
    if (hits.fate != MET && found.kind != MEETING_NONE) add_meeting_found(orbit, m.s, way, found, hits);
#endif
    if (met) m.fate = MET;
#else
    march_on(orbit, ORDERS > 0, m);
    float end = march_end(orbit, m);
#endif
#if ORDERS > 0 && !MEETINGS
    // From crossing to crossing. Most rays cross once: the step to a crossing is as dear as three of the march, and a loop that began with the
    // march would run it once more for each ray. A ray that is done has `crossed` false, so that further rounds leave it as it is.
    int found = 0;
    do {
        if (m.crossed) find_crossing(orbit, m.s, m.next, m.h, end, hits);
        ++found;
        m.crossed = m.crossed && m.fate == UNRESOLVED && m.steps < plan_max_steps;
        if (m.crossed) march_on(orbit, found < ORDERS, m);
        end = march_end(orbit, m);
    } while (m.crossed);
#endif
#if POST_VIEW_CONSERVATION && defined(RAY_DRIFT)
    march_drift = RAY_DRIFT(orbit, m.next);
#endif
    hits.steps = m.steps;
    hits.fate = m.fate;
#if !RAYS_EARLY_END
    hits.steps = steps_gone_on(orbit, m);
#endif
    if (m.fate == ESCAPED) ray_finish(orbit, march_step(orbit, m.s, m.h * end), hits);
    return hits;
}
