// Marches a differential ray model: steps until the ray has escaped or is captured, and finds its crossings of z = 0 on the way.
//
// A differential model (shaders/ray_models/) gives
//     struct Orbit                                constants of this ray
//     struct State                                what the integrator moves
//     Orbit ray_orbit(RayStart)
//     State ray_init(RayStart, Orbit, inout Hits) may add crossings that lie before the march
//     State ray_rhs(Orbit, State)                 the State's rate
//     State state_step(State s, float h, State k) s + h k
//     int   ray_fate(Orbit, State)                UNRESOLVED while under way
//     float ray_end(Orbit, State a, State b, float h)  fraction 0…1 of the last step at which the ray ends
//     void  ray_finish(Orbit, State, inout Hits)  from the end of the march to infinity
//     float ray_height(State), ray_height_rate(State)  of the sign of z
//     vec2  ray_plane_point(State)                r·(cos φ, sin φ) in r_s
// and, for those integrators and step controls that ask for them,
//     State state_kick(State s, float h, State k), state_drift(State s, float h)   what only places drive moved by h k; places moved by their rates
//     State state_push(State s, float h2, State k)      places moved by h2 times the rates of their rates
//     float state_difference(Orbit, State a, State b)   about the angle in radians by which two ends of one step differ
//     float ray_plain_step(Orbit, State), ray_longest_step(Orbit, State)   the step before any control; the longest in which nothing is missed
//     float ray_radius(State), ray_elevation(State)     in r_s; sine of the angle above z = 0
// RAY_RECHARTS: State ray_recharted(State a, State b)  `b`, or the same place in coordinates that suit the way from `a` better.
// RAY_FIRST_ORDER: places are not moved by rates of their own: there is no state_drift and no state_push.
// RAY_QUADRATURE: names a function (Orbit, State a, float h, inout State b) that completes what follows from a step but drives nothing.
// RAY_DRIFT: names a function float (Orbit, State)   how far a quantity that should stay is from where it should be, relative to its
// size; −1 for none. For the view of conserved quantities only.
//
// A step control gives step_size(Orbit, State), or with STEP_ADAPTS
//     State adapted_step(Orbit, State s, inout float trial, out float h)   one step of length h ≤ trial; rejected: s itself, with h = 0
// An integrator gives integrator_step(Orbit, State, float h), one with an error estimate also integrator_pair and INTEGRATOR_ERROR_POWER.

State completed(Orbit orbit, State s, float h, State next) {
#ifdef RAY_QUADRATURE
    RAY_QUADRATURE(orbit, s, h, next);
#endif
    return next;
}

State march_step(Orbit orbit, State s, float h) {
    return completed(orbit, s, h, integrator_step(orbit, s, h));
}

#if ORDERS > 0
// The side of the plane that a ray is on; in the plane, the one it heads for, so that the camera's own place there does not count.
bool is_below(State s) {
    return ray_height(s) < 0.0 || (ray_height(s) == 0.0 && ray_height_rate(s) < 0.0);
}

// One crossing between `a` and the state a step of `h` later. The root found on the cubic Hermite polynomial is stepped to again,
// so that the crossing is as accurate as the march and not as the polynomial.
void find_crossing(Orbit orbit, State a, State b, float h, float end, inout Hits hits) {
    float t = hermite_root(ray_height(a), h * ray_height_rate(a), ray_height(b), h * ray_height_rate(b));
    if (t >= end) return;
    State there = march_step(orbit, a, h * t);
    float slip = clamp(-ray_height(there) / ray_height_rate(there), -0.1 * h, 0.1 * h);
#ifdef RAY_FIRST_ORDER
    there = state_step(there, slip, ray_rhs(orbit, there));
#else
    there = state_drift(there, slip);
#endif
    vec2 point = ray_plane_point(there);
    if (dot(point, point) > crossing_r_min * crossing_r_min) add_crossing(hits, point);
}
#endif

// llvmpipe (Mesa 22.3) hands on what the body of a loop with one exit computed for a finished ray in later rounds. Where the body is a function of
// the state alone that is the same, and saves copies of two states a round (docs/performance.md). A trial step or a change of chart is
// altered by the round itself: those loops get a second exit, which keeps every ray's own values.
#if defined(STEP_ADAPTS) || defined(RAY_RECHARTS)
#define MARCH_REPEATS 0
#else
#define MARCH_REPEATS 1
#endif

// The inner loop only steps: software renderers run every branch of a loop body in every round, so what happens once a ray or
// once a crossing stands outside it.
Hits trace_ray(RayStart start) {
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    State s = ray_init(start, orbit, hits);
    State next = s;
    float h = 0.0;
    float end = 1.0;
    int fate = UNRESOLVED;
    int steps = 0;
#ifdef STEP_ADAPTS
    float trial = ray_plain_step(orbit, s);
#endif
    for (int leg = 0; leg <= ORDERS; ++leg) {
        bool crossed = false;
#if MARCH_REPEATS
        do {
#else
        while (steps < plan_max_steps) {
#endif
#ifdef RAY_RECHARTS
            next = ray_recharted(s, next);
#endif
            s = next;
#ifdef STEP_ADAPTS
            next = adapted_step(orbit, s, trial, h);
            next = completed(orbit, s, h, next);
#else
            h = step_size(orbit, s);
            next = march_step(orbit, s, h);
#endif
            ++steps;
            fate = ray_fate(orbit, next);
#if ORDERS > 0
            crossed = is_below(next) != is_below(s) && leg < ORDERS;
#endif
#if MARCH_REPEATS
        } while (!crossed && fate == UNRESOLVED && steps < plan_max_steps);
#else
            if (crossed || fate != UNRESOLVED) break;
        }
#endif
        end = fate == ESCAPED ? ray_end(orbit, s, next, h) : 2.0;  // or beyond the step, whose very end may be a crossing
#if ORDERS > 0
        if (crossed) find_crossing(orbit, s, next, h, end, hits);
#endif
        if (fate != UNRESOLVED || steps >= plan_max_steps) break;
    }
#if POST_VIEW_CONSERVATION && defined(RAY_DRIFT)
    march_drift = RAY_DRIFT(orbit, next);
#endif
    hits.steps = steps;
    hits.fate = fate;
    if (fate == ESCAPED) ray_finish(orbit, march_step(orbit, s, h * end), hits);
    return hits;
}
