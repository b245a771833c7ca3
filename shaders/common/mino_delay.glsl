// Delays of rays whose states carry the time in M: what the march and things that move ask for, in r_s/c. Included after State and time_end.

float ray_delay(State s) {
    return 0.5 * s.time;
}

float ray_delay_rate(Orbit orbit, State s) {
    return 0.5 * time_rate(time_constants(orbit), time_end(orbit, s));
}

vec2 path_time(Orbit orbit, State s) {
    return path_time_at(s.w, s.w_rate, ray_delay(s), s.w > 0.0 ? ray_delay_rate(orbit, s) : 0.0);
}

State ray_delayed(State s, float delay) {
    s.time += 2.0 * delay;
    return s;
}
