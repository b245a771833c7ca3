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

// One crossing between `a` and the state a step of `h` later. The root found on the cubic Hermite polynomial is stepped to again,
// so that the crossing is as accurate as the march and not as the polynomial.
#if ORDERS > 0
void find_crossing(Orbit orbit, State a, State b, float h, float end, inout Hits hits) {
    float t = hermite_root(ray_height(a), h * ray_height_rate(a), ray_height(b), h * ray_height_rate(b));
    if (t >= end) return;
    State there = integrator_step(orbit, a, h * t);
    float slip = clamp(-ray_height(there) / ray_height_rate(there), -0.1 * h, 0.1 * h);
    there = state_step(there, slip, ray_rhs(orbit, there));
    vec2 point = ray_plane_point(there);
    if (dot(point, point) > crossing_r_min * crossing_r_min) add_crossing(hits, point);
}
#endif

Hits trace_ray(RayStart start) {
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    State s = ray_init(start, orbit, hits);
#if ORDERS > 0
    float side = sign(ray_height(s));  // 0: the camera's own place in the plane does not count
#endif
    for (int i = 0; i < plan_max_steps; ++i) {
        float h = step_size(orbit, s);
        State next = integrator_step(orbit, s, h);
        int fate = ray_fate(orbit, next);
        float end = fate == ESCAPED ? ray_end(orbit, s, next, h) : 1.0;
#if ORDERS > 0
        float next_side = sign(ray_height(next));
        if (side * next_side < 0.0) find_crossing(orbit, s, next, h, end, hits);
        side = next_side == 0.0 ? side : next_side;
#endif
        hits.steps = i + 1;
        if (fate != UNRESOLVED) {
            hits.fate = fate;
            if (fate == ESCAPED) ray_finish(orbit, end < 1.0 ? integrator_step(orbit, s, h * end) : next, hits);
            break;
        }
        s = next;
    }
    return hits;
}
