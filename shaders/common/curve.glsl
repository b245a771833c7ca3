// A ray's way between two states, as a curve in space: dense output. What things are met on it is for meetings.glsl.
//
// Places are homogeneous: (p, q) is the place p/q in r_s, in the plan's frame; with q = 0 it is infinitely far away in the direction p, so that a step may begin or
// end there. A model that twists (ray_models/kerr.glsl) has its way before the twist here, and the twist beside it: each is a cubic by itself, and
// near the horizon the twist turns much faster than the way bends.

// A state in space, and its rates by the parameter of the march.
struct Path {
    vec4 place;  // homogeneous, before the twist
    vec4 rate;
    vec2 twist;  // about the spin axis, and its rate
};

struct Curve {
    Path a, b;
    float h;     // from a to b, in the parameter of the march
};

// Cubic Hermite polynomials at t for (value at 0, slope at 0, value at 1, slope at 1), slopes per whole step; and their slopes.
vec4 hermite_weights(float t) {
    float s = 1.0 - t;
    return vec4(s * s * (1.0 + 2.0 * t), s * s * t, t * t * (3.0 - 2.0 * t), -t * t * s);
}

vec4 hermite_slopes(float t) {
    float s = 1.0 - t;
    return vec4(-6.0 * s * t, s * (1.0 - 3.0 * t), 6.0 * s * t, t * (3.0 * t - 2.0));
}

vec4 path_place(Path path) {
    return vec4(rotate(path.place.xy, cos_sin(path.twist.x)), path.place.zw);
}

// Where the curve is at t in 0…1, homogeneous, and `rate`, how fast it changes there.
vec4 curve_place(Curve curve, float t, out vec4 rate) {
    vec4 weights = hermite_weights(t), slopes = hermite_slopes(t);
    Path a = curve.a, b = curve.b;
    vec4 place = weights.x * a.place + weights.z * b.place + curve.h * (weights.y * a.rate + weights.w * b.rate);
    rate = slopes.x * a.place + slopes.z * b.place + curve.h * (slopes.y * a.rate + slopes.w * b.rate);
    float twist = weights.x * a.twist.x + weights.z * b.twist.x + curve.h * (weights.y * a.twist.y + weights.w * b.twist.y);
    float twist_rate = slopes.x * a.twist.x + slopes.z * b.twist.x + curve.h * (slopes.y * a.twist.y + slopes.w * b.twist.y);
    vec2 turn = cos_sin(twist);
    place.xy = rotate(place.xy, turn);
    rate.xy = rotate(rate.xy, turn) + twist_rate * vec2(-place.y, place.x);
    return place;
}
