// Light that is gathered along a ray, and what a thing or a medium is told of how it is seen.

// On its way to the camera: gathered so far, and the share of what lies farther on that still comes through.
struct Light {
    vec3 gathered;
    vec3 passed;
};

#if MEETINGS
struct Sight {
    vec3 place;     // r_s
    vec3 towards;   // unit vector along the ray there, towards the camera
    float energy;   // E_observer/E_infinity
    bool enters;    // the ray goes into it, traced backwards
};

Sight sight_of(Meeting met, float energy) {
    float r = length(met.place);
    vec3 n = met.place / r;
    vec3 backwards = (0.5 / r) * met.momentum.n_rate - met.momentum.w_rate * n;
    return Sight(met.place, -normalize(backwards), energy, met.enters);
}

// E_infinity/E_emitter of light from matter at rest at radius r, outside the horizon; 1 in flat space.
float rest_shift(float r) {
#if SPACE_TIME_FLAT
    return 1.0;
#else
    return sqrt(max(1.0 - 1.0 / r, 0.0));
#endif
}
#endif
