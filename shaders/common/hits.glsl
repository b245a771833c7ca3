// What became of a ray, and how the hit map stores it. Directions stay vectors and crossings stay points: no angle is ever stored.

struct Hits {
    int fate;          // UNRESOLVED, ESCAPED, CAPTURED
    vec3 direction;    // asymptotic, world, unit; zero unless escaped
    float lambda;      // L_z/E in M
    int steps;
    vec2 crossing[3];  // r·(cos φ, sin φ) in r_s of the crossings of z = 0, nearest along the ray first; zero = none
};

Hits no_hits(float lambda) {
    return Hits(UNRESOLVED, vec3(0.0), lambda, 0, vec2[3](vec2(0.0), vec2(0.0), vec2(0.0)));
}

// Puts a crossing into the first free place; those beyond ORDERS are dropped.
void add_crossing(inout Hits hits, vec2 point) {
    if (hits.crossing[0] == vec2(0.0)) hits.crossing[0] = point;
    else if (hits.crossing[1] == vec2(0.0)) hits.crossing[1] = point;
    else if (hits.crossing[2] == vec2(0.0)) hits.crossing[2] = point;
}
