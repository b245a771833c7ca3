// Null orbits of Schwarzschild in closed form, without angles, sin or elliptic functions. r_s = 1, u = 1/r, κ = 1/b²: u'² = u³ − u² + κ by φ.
//
// All orbits of one κ are one and the same elliptic function. So the orbit that leaves r = 0 at φ = 0 serves them all: Weierstrass'
// addition theorem carries any place on any orbit on by φ, given r and dr/dφ of that one orbit at φ.

const float CENTRE_REACH = 0.25;  // κ sin⁶(φ/2) up to which `orbit_from_centre` holds: all of the way between infinity and the horizon, φ ≤ π

// (r, dr/dφ) at φ in 0…π, given as (cos φ, sin φ), on the orbit that leaves r = 0 at φ = 0. Relative error 1e-7 and less.
//
// It obeys r'² = r − r² + κr⁴. Without κ it is sin²(φ/2), and what κ adds is small at φ/2: a polynomial fitted by tools/fit_orbit_from_centre.py.
// The duplication theorem leads from there to φ.
vec2 orbit_from_centre(vec2 turn, float kappa) {
    float larger = sqrt(0.5 + 0.5 * abs(turn.x));
    float smaller = 0.5 * turn.y / larger;
    vec2 half_turn = turn.x >= 0.0 ? vec2(larger, smaller) : vec2(smaller, larger);
    float p = 0.5 * half_turn.y * half_turn.y / (1.0 + half_turn.x);
    float e = kappa * p * p * p;
    float fit = 0.14346393 + p * (0.08439174 + p * (0.13910081 + p * (-0.14282091 + p * 0.26320831))) + e * (0.00476785 + p * 0.07722022);
    float r = p + p * e * fit;
    float bend = kappa * r * r * r;
    float rate2 = r * (1.0 - r + bend);
    float below = 1.0 / (1.0 - 4.0 * bend * (2.0 - r));
    float doubled = 4.0 * rate2 * below;
    float slope = 2.0 - 4.0 * r + 8.0 * bend + doubled * kappa * r * r * (12.0 - 8.0 * r);
    return vec2(doubled, sqrt(rate2) * slope * below);
}

// 1/u as (numerator, denominator), after φ on an orbit that starts with (u, du/dφ) = `start`; `centre` is orbit_from_centre at φ.
vec2 orbit_on(vec2 start, vec2 centre, float kappa) {
    float below = 1.0 - start.x * centre.x;
    float above = start.x + centre.x * (start.x * (start.x - 2.0) + 2.0 * kappa * centre.x) + 2.0 * start.y * centre.y;
    return vec2(below * below, above);
}

// (u, du/dφ) there.
vec2 orbit_state_on(vec2 start, vec2 centre, float kappa) {
    float below = 1.0 / (1.0 - start.x * centre.x);
    float bend = 2.0 * kappa * centre.x;
    float above = start.x + centre.x * (start.x * (start.x - 2.0) + bend) + 2.0 * start.y * centre.y;
    float above_rate = centre.y * (start.x * (start.x - 2.0) + 2.0 * bend) + start.y * (1.0 - 2.0 * centre.x + 2.0 * bend * centre.x * centre.x);
    float u = above * below * below;
    return vec2(u, (above_rate * below + 2.0 * start.x * centre.y * u) * below);
}

// 1/u as (numerator, denominator), at φ before the orbit's end: at infinity, or in r = 0.
vec2 orbit_before_end(bool escapes, vec2 centre, float kappa, float root_kappa) {
    return escapes ? vec2(1.0, 2.0 * root_kappa * (root_kappa * centre.x * centre.x + centre.y)) : vec2(centre.x, 1.0);
}
