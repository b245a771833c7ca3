// What models share whose State has w = M/r and w_rate as unknowns of their own in Mino time, and whose Orbit has scale, the time of about one radian.

float ray_longest_step(Orbit orbit, State s) {
    return orbit.scale;
}

float ray_radius(State s) {
    return 0.5 / max(s.w, 1e-6);
}

// Inside hole_w_stop an inward ray has no turning point left; infinity is w = 0.
int ray_fate(Orbit orbit, State s) {
#if CAMERA_FALLS
    if (orbit.energy == 0.0) return CAPTURED;
#endif
    if (s.w <= 0.0) return ESCAPED;
    return s.w > hole_w_stop && s.w_rate > 0.0 ? CAPTURED : UNRESOLVED;
}

float ray_end(Orbit orbit, State a, State b, float h) {
    return hermite_root(a.w, h * a.w_rate, b.w, h * b.w_rate);
}
