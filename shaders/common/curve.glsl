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
#if RAYS_LIGHT_TRAVEL
    vec2 delay;  // q times the time of light from here to the camera, which is finite far out, too; and its rate
#endif
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

// Where it is in r_s.
vec3 path_point(Path path) {
    vec4 place = path_place(path);
    return place.xyz / place.w;
}

#if RAYS_LIGHT_TRAVEL
// Of light from there to the camera, r_s/c.
float path_delay(Path path) {
    return path.delay.x / path.place.w;
}
#endif

// A value and its rate between those of two ends, `h` apart.
vec2 hermite(vec4 weights, vec4 slopes, float h, vec2 a, vec2 b) {
    return vec2(weights.x * a.x + weights.z * b.x + h * (weights.y * a.y + weights.w * b.y), slopes.x * a.x + slopes.z * b.x + h * (slopes.y * a.y + slopes.w * b.y));
}

// The curve at t in 0…1; its rates are by the curve's own parameter.
Path curve_path(Curve curve, float t) {
    vec4 weights = hermite_weights(t), slopes = hermite_slopes(t);
    Path a = curve.a, b = curve.b;
    return Path(
        weights.x * a.place + weights.z * b.place + curve.h * (weights.y * a.rate + weights.w * b.rate),
        slopes.x * a.place + slopes.z * b.place + curve.h * (slopes.y * a.rate + slopes.w * b.rate),
        hermite(weights, slopes, curve.h, a.twist, b.twist) AND_TIME(hermite(weights, slopes, curve.h, a.delay, b.delay)));
}

// How fast it moves, r_s by the parameter of its rates.
vec3 path_velocity(Path path) {
    vec3 x = path.place.xyz / path.place.w;
    vec3 rate = (path.rate.xyz - x * path.rate.w) / path.place.w + path.twist.y * vec3(-x.y, x.x, 0.0);
    return vec3(rotate(rate.xy, cos_sin(path.twist.x)), rate.z);
}

// Distance of a homogeneous place from the hole less r, but that it is finite at infinity too.
float beyond(vec4 place, float r) {
    return length(place.xyz) - r * place.w;
}

// The rate of `beyond`.
float beyond_rate(Path path, float r) {
    return dot(path.place.xyz, path.rate.xyz) / max(length(path.place.xyz), 1e-20) - r * path.rate.w;
}

// The part 0…1 of the curve at which it comes nearer to the hole than r; 1 where it begins nearer or ends farther away.
float part_outside(Curve curve, float r) {
    float above = beyond(curve.a.place, r), below = beyond(curve.b.place, r);
    if (above <= 0.0 || below >= 0.0) return 1.0;
    return hermite_root(above, curve.h * beyond_rate(curve.a, r), below, curve.h * beyond_rate(curve.b, r));
}

// From the nearest place of the piece from the origin along `way` to x.
vec3 beside(vec3 x, vec3 way) {
    return x - clamp(dot(x, way) / max(dot(way, way), 1e-30), 0.0, 1.0) * way;
}

// How far the way between two places of a curve strays from the straight piece between them, at most, or from that piece moved `aside`, as ways bow to one side.
struct Stray {
    float off, moved_off;  // r_s
    vec3 aside;
};

// That of two places `part` of the curve's parameter apart. Before the twist the way lies between the control points of a rational cubic, of which
// those at its ends lie on the piece and the other two count for three quarters at most, or more by their larger weights. A turn by φ moves what
// is ρ from the axis by less than ρφ²/8 more, and uneven steps of either along the piece by as much as they are uneven.
Stray path_stray(Path a, Path b, float part) {
    vec4 first = a.place + part / 3.0 * a.rate, second = b.place - part / 3.0 * b.rate;
    vec3 from = a.place.xyz / a.place.w, way = b.place.xyz / b.place.w - from;
    vec3 p = first.xyz / first.w - from, q = second.xyz / second.w - from;
    float inner = 3.0 * max(first.w, second.w), share = inner / (inner + min(a.place.w, b.place.w));
    vec3 of_p = share * beside(p, way), of_q = share * beside(q, way);
    bool is_p = dot(of_p, of_p) > dot(of_q, of_q);
    vec3 aside = 0.5 * (is_p ? of_p : of_q), other = (is_p ? of_q : of_p) - aside;
    float half_off = length(aside), moved = max(half_off, length(other)), stray = 2.0 * half_off;
    float turn = abs(b.twist.x - a.twist.x), uneven = max(abs(part * a.twist.y), abs(part * b.twist.y)) - turn;
    float size = length(from) + length(way) + stray;
    float twisted = turn * (0.5 * length(way) + 0.125 * turn * size) + max(uneven, 0.0) / 3.0 * size;
    bool ends = min(min(first.w, second.w), min(a.place.w, b.place.w)) > 0.0;
    aside.xy = rotate(aside.xy, cos_sin(a.twist.x));
    return Stray(ends ? stray + twisted : 1e30, moved + turn * half_off + twisted, aside);
}

// How a way bends between two places of it: beside the part s of the straight piece between them it lies 4 s (1 − s) times the bow from there, and strays from that by
// `off`; r_s.
struct Bend {
    vec3 bow;
    float off;
};

Bend no_bend(float stray) {
    return Bend(vec3(0.0), stray);
}

// How far it strays from the straight piece.
float bent_stray(Bend bend) {
    return length(bend.bow) + bend.off;
}

// That of the way from a to b by way of the `middle`: by its directions at both ends, of which the bow's are the mean, and by how far it is from there in the middle.
Bend path_bend(Path a, Path middle, Path b) {
    vec3 from = path_point(a), way = path_point(b) - from, begins = path_velocity(a), ends = path_velocity(b);
    float way2 = max(dot(way, way), 1e-30), forth = dot(begins, way), back = dot(ends, way);
    vec3 rise = way2 / forth * begins - way, fall = way - way2 / back * ends, bow = 0.125 * (rise + fall);
    vec3 between = path_point(middle) - from;
    float s = clamp(dot(between, way) / way2, 0.0, 1.0);
    float aside = distance(between, s * way + 4.0 * s * (1.0 - s) * bow);
    bool is_told = min(forth, back) > 0.0 && min(min(a.place.w, b.place.w), middle.place.w) > 0.0;
    return is_told ? Bend(bow, 0.05 * distance(rise, fall) + 2.0 * aside) : no_bend(1e30);
}

// Whether nothing within `reach` of the hole is met from a on, as the way from there to b leads outwards.
bool path_leaves(Path a, Path b, float reach) {
    float from2 = dot(a.place.xyz, a.place.xyz), to2 = dot(b.place.xyz, b.place.xyz);
    bool outwards = b.place.w <= 0.0 || to2 * a.place.w * a.place.w >= from2 * b.place.w * b.place.w;
    return outwards && from2 > reach * reach * a.place.w * a.place.w;
}

// A whole step of h, as a cubic for each half: near the hole a long one is none.
struct Way {
    Path a, middle, b;
    float h;
};

// The way at t in 0…1; its rates are by t.
Path way_path(Way way, float t) {
    bool later = t > 0.5;
    Curve half_way = Curve(way.a, way.middle, 0.5 * way.h);
    if (later) half_way = Curve(way.middle, way.b, 0.5 * way.h);
    Path found = curve_path(half_way, later ? 2.0 * t - 1.0 : 2.0 * t);
    return Path(found.place, 2.0 * found.rate, vec2(found.twist.x, 2.0 * found.twist.y) AND_TIME(vec2(found.delay.x, 2.0 * found.delay.y)));
}
