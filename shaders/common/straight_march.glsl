// Straight rays as a march takes them (common/march.glsl): for what goes on along a ray of the closed model of flat space.

struct Orbit {
    vec3 v;  // unit vector
};

struct State {
    vec3 x;  // r_s
};

Orbit ray_orbit(RayStart start) {
    return Orbit(normalize(start.w * start.n_rate - start.w_rate * start.n));
}

State ray_init(RayStart start, Orbit orbit, inout Hits hits) {
    return State(start.n * (0.5 / start.w));
}

State march_step(Orbit orbit, State s, float h) {
    return State(s.x + h * orbit.v);
}

int ray_fate(Orbit orbit, State s) {
    return UNRESOLVED;
}

float ray_plain_step(Orbit orbit, State s) {
    return 1e30;
}

float ray_affine_rate(Orbit orbit, State s) {
    return 1.0;
}

Path ray_path(Orbit orbit, State s) {
    return Path(vec4(s.x, 1.0), vec4(orbit.v, 0.0), vec2(0.0));
}

Momentum ray_momentum(Orbit orbit, State s) {
    return momentum_at(s.x, orbit.v);
}
