// Rotations by an angle, without the driver's sin and cos, whose accuracy the standard leaves open.

// (cos, sin) of x beyond so many quarters of a turn, |x| ≤ π/4: Taylor polynomials whose remainder at π/4 is below 2e-9.
vec2 cos_sin_beside(int quarter, float x) {
    float x2 = x * x;
    float s = x * (1.0 + x2 * (-1.66666667e-1 + x2 * (8.33333333e-3 + x2 * (-1.98412698e-4 + x2 * 2.75573192e-6))));
    float c = 1.0 + x2 * (-0.5 + x2 * (4.16666667e-2 + x2 * (-1.38888889e-3 + x2 * (2.48015873e-5 - x2 * 2.75573192e-7))));
    int octant = quarter & 3;
    vec2 turned = (octant & 1) == 0 ? vec2(c, s) : vec2(-s, c);
    return octant < 2 ? turned : -turned;
}

// (cos, sin) of `angle` in radians, |angle| < 1000: reduction to ±π/4 in two parts (Cody & Waite).
vec2 cos_sin(float angle) {
    float quarter = floor(angle * 0.636619772 + 0.5);
    return cos_sin_beside(int(quarter), (angle - quarter * 1.5707855225) - quarter * 1.0804334124e-5);
}

// The same of an angle in whole turns, to 2e-7: polynomials on a quarter of a turn to both sides, fitted in Chebyshev's points.
vec2 cos_sin_turns(float turn) {
    float beyond_half = turn - floor(turn) - 0.5, t = 0.25 - abs(beyond_half), s = t * t;
    float c = 0.99999995 + s * (-19.7391713 + s * (64.9345816 + s * (-85.2401004 + s * 56.2405404)));
    return vec2(t * (-6.28318528 + s * (41.3416807 + s * (-81.6024807 + s * (76.5812846 - s * 39.7607221)))), beyond_half < 0.0 ? c : -c);
}

// `v` turned by the angle whose (cos, sin) is `turn`.
vec2 rotate(vec2 v, vec2 turn) {
    return vec2(v.x * turn.x - v.y * turn.y, v.x * turn.y + v.y * turn.x);
}

// `v` in axes that the unit quaternion (x, y, z, w) turns to the world's.
vec3 unturned(vec4 attitude, vec3 v) {
    return v + 2.0 * cross(attitude.xyz, cross(attitude.xyz, v) - attitude.w * v);
}

// The angle of (x, y) in turns, −½…½, to 2e-6, for half of what the driver's atan takes.
float turns(float x, float y) {
    vec2 size = abs(vec2(x, y));
    float slope = min(size.x, size.y) / max(max(size.x, size.y), 1e-20);
    float s = slope * slope;
    float angle = slope * (0.15913366 + s * (-0.05256959 + s * (0.02867300 + s * (-0.01355268 + s * 0.00331740))));
    angle = size.y > size.x ? 0.25 - angle : angle;
    angle = x < 0.0 ? 0.5 - angle : angle;
    return y < 0.0 ? -angle : angle;
}
