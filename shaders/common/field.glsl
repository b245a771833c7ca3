// What the models share that bend rays by a field in flat space: x'' = f(x, x') within the sphere of rays_field_radius about the origin, straight lines
// beyond it. There is no hole: nothing is captured, and spin means nothing. A model gives
//     vec3 field_acceleration(vec3 x, vec3 v)   f; x in r_s, v = dx/dσ. It is asked for a step's length beyond the sphere too
// FIELD_SPEED: names a function float (vec3 x), |v| of a ray that begins or enters at x; without it 1
// FIELD_LENGTH: names a function float (vec3 x, vec3 v), how long a step may be at x where the plan's is for where the field changes fastest, or at 3 r_s from its centre,
//     over that; without it 1. It is smooth, so that neighbours take like steps
// FIELD_ENERGY: names a function float (vec3 x, vec3 v) that is the same all along a ray, for the view of conserved quantities
//
// The march is of the way within the sphere alone. It begins where a ray comes in, or at a camera inside, and ends where the ray goes out; the straight
// ways before and after are looked at once a ray. A ray that has gone rays_field_way within is held there: it ends as CAPTURED, and is black.

#include "common/disk_plane.glsl"

#define RAY_MEETS_BEYOND
#define RAY_STEPS_SHORT

struct Orbit {
    float bends;   // 1 for a ray that comes into the sphere; 0 for one that passes it by
    float energy;  // where it comes in
};

struct State {
    vec3 x;
    vec3 v;
    float way;  // gone within the sphere: its length, or σ where the ray is slower than 1
};

// The straight way that a ray comes in on, x = nearest + t v with t from `begin` to `enter`; `leave` is where it would go out again.
struct Approach {
    vec3 nearest, v;
    float begin, enter, leave;
};

// Written from the impact vector, so that a far camera loses no digits and one at infinity is no case of its own.
Approach field_approach(RayStart start) {
    float bend = length(start.n_rate);
    vec3 across = bend > 0.0 ? start.n_rate / bend : vec3(0.0);
    float b = 0.5 * bend, cosine = start.w_rate, sine = start.w * bend;
    vec3 v = normalize(sine * across - cosine * start.n);
    vec3 nearest = b * (sine * start.n + cosine * across);
    float reach = rays_field_radius + b;
#if MEETINGS
    reach += meeting_reach;
#endif
    float begin = start.w > 0.0 ? -0.5 * cosine / start.w : -2.0 * reach;
#if ORDERS > 0
    if (start.w == 0.0 && disk_height(v) != 0.0) begin -= abs(disk_height(nearest) / disk_height(v));
#endif
    float half_chord = sqrt(max((rays_field_radius - b) * (rays_field_radius + b), 0.0));
    return Approach(nearest, v, begin, max(begin, -half_chord), half_chord);
}

// What lies on the straight way from x on, `far` long, v a unit vector. Whether it ends on something opaque.
bool field_leg(vec3 x, vec3 v, float far, inout Hits hits) {
    float crossing = -1.0;
#if ORDERS > 0
    vec2 heights = vec2(disk_height(x), disk_height(v));
    if (heights.x != 0.0 && heights.y != 0.0) crossing = -heights.x / heights.y;
#endif
    vec2 point = in_disk_axes(x + crossing * v).xy;
#if MEETINGS
    return meet_along_line(x, v, far, crossing, point, hits);
#else
    if (crossing > 0.0 && crossing < far) add_crossing(hits, point, momentum_at(disk_place(point), v));
    return false;
#endif
}

float field_entry_speed(vec3 x) {
#ifdef FIELD_SPEED
    return FIELD_SPEED(x);
#else
    return 1.0;
#endif
}

Orbit ray_orbit(RayStart start) {
    Approach way = field_approach(start);
    float energy = 0.0;
#ifdef FIELD_ENERGY
    vec3 x = way.nearest + way.enter * way.v;
    energy = FIELD_ENERGY(x, field_entry_speed(x) * way.v);
#endif
    return Orbit(way.leave > way.enter ? 1.0 : 0.0, energy);
}

State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
    Approach way = field_approach(start);
    // A camera in the plane z = 0 is in it exactly.
    vec3 x = start.w > 0.0 ? start.n * (0.5 / start.w) : way.nearest + way.begin * way.v;
#if MEETINGS
    meet_at_start(x, momentum_at(x, way.v), hits);
#endif
    if (orbit.bends > 0.0 && way.enter > way.begin) {
        if (field_leg(x, way.v, way.enter - way.begin, hits)) hits.fate = MET;
        x = (1.0 - 4e-7) * (way.nearest + way.enter * way.v);  // within by more than a rounding: it has come in, and not left
    }
    return State(x, field_entry_speed(x) * way.v, 0.0);
}

State ray_rhs(Orbit orbit, State s) {
    return State(s.v, orbit.bends * field_acceleration(s.x, s.v), max(length(s.v), 1.0));
}

State state_step(State s, float h, State k) {
    return State(s.x + h * k.x, s.v + h * k.v, s.way + h * k.way);
}

State state_kick(State s, float h, State k) {
    return State(s.x, s.v + h * k.v, s.way);
}

State state_push(State s, float h2, State k) {
    return State(s.x + h2 * k.v, s.v, s.way);
}

State state_drift(State s, float h) {
    return State(s.x + h * s.v, s.v, s.way + h * max(length(s.v), 1.0));
}

float state_difference(Orbit orbit, State a, State b) {
    return distance(a.x, b.x) / rays_field_radius + distance(a.v, b.v) / length(b.v);
}

float ray_radius(State s) {
    return length(s.x);
}

// A step of σ is no longer in space than it was asked to be.
float ray_slowdown(State s) {
    return 1.0 / max(length(s.v), 1.0);
}

float ray_plain_step(Orbit orbit, State s) {
    return plan_step_length * ray_slowdown(s);
}

#define RAY_SCALED_STEP field_scaled_step
float field_scaled_step(Orbit orbit, State s) {
#ifdef FIELD_LENGTH
    return ray_plain_step(orbit, s) * FIELD_LENGTH(s.x, s.v);
#else
    return ray_plain_step(orbit, s);
#endif
}

float ray_longest_step(Orbit orbit, State s) {
    return 0.25 * rays_field_radius * ray_slowdown(s);
}

float field_beyond(State s) {
    return dot(s.x, s.x) - rays_field_radius * rays_field_radius;
}

int ray_fate(Orbit orbit, State s) {
    if (orbit.bends == 0.0 || field_beyond(s) >= 0.0) return ESCAPED;
    return s.way > rays_field_way ? CAPTURED : UNRESOLVED;
}

float ray_end(Orbit orbit, State a, State b, float h) {
    if (orbit.bends == 0.0) return 0.0;
    float before = field_beyond(a), after = field_beyond(b);
    if (before >= 0.0) return 0.0;
    float inwards = 2.0 * h * dot(a.x, a.v), outwards = 2.0 * h * dot(b.x, b.v);
    if (inwards >= 0.0) return hermite_root(before, inwards, after, outwards);
    // A step that goes in and out again may begin on the sphere, where the other root is: from where a straight way back comes to it.
    float speed = length(b.v), along = dot(b.x, b.v) / speed;
    return hermite_root_near(1.0 - (along - sqrt(max(along * along - after, 0.0))) / (speed * h), before, inwards, after, outwards);
}

// The root on the polynomial is as good as a cubic: what is left to the sphere is gone by the rates there.
void ray_finish(Orbit orbit, State s, inout Hits hits) {
    if (orbit.bends > 0.0) {
        float slip = -field_beyond(s) / (2.0 * dot(s.x, s.v));
        float most = 0.1 * plan_step_length;
        s = state_step(s, abs(slip) < most ? slip : 0.0, ray_rhs(orbit, s));
    }
    vec3 v = normalize(s.v);
    if (field_leg(s.x, v, 1e30, hits)) hits.fate = MET;
    else hits.direction = v;
}

#ifdef FIELD_ENERGY
#define RAY_DRIFT ray_drift
float ray_drift(Orbit orbit, State s) {
    return orbit.bends * abs(FIELD_ENERGY(s.x, s.v) - orbit.energy) / max(0.5 * dot(s.v, s.v), 1e-3);
}
#endif

float ray_height(State s) {
    return s.x.z;
}

float ray_height_rate(State s) {
    return s.v.z;
}

float ray_elevation(State s) {
    return s.x.z / ray_radius(s);
}

float ray_affine_rate(Orbit orbit, State s) {
    return length(s.v);
}

vec2 ray_plane_point(State s) {
    return s.x.xy;
}

Path ray_path(Orbit orbit, State s) {
    return Path(vec4(s.x, 1.0), vec4(s.v, 0.0), vec2(0.0));
}

// Of light that comes along the way: it has no more energy where the ray runs faster.
Momentum ray_momentum(Orbit orbit, State s) {
    return momentum_at(s.x, normalize(s.v));
}
