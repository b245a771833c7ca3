// One step of a marched ray, whatever its length.

State completed(Orbit orbit, State s, float h, State next) {
#ifdef RAY_QUADRATURE
    RAY_QUADRATURE(orbit, s, h, next);
#endif
    return next;
}

State march_step(Orbit orbit, State s, float h) {
    return completed(orbit, s, h, integrator_step(orbit, s, h));
}
