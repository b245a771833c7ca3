// Where a ray meets the scene's things and media, in order along the curve that it takes; never by jumping.
//
// A kind of thing (shaders/things/<key>.glsl) or medium (shaders/media/<key>.glsl) tells
//     float thing_<key>_distance(int i, vec3 x)   of instance i: signed, of two signs on the two sides of its surface, and in size at most how far x
//                                                 is from it, in r_s; x in the world
// So a ray may go on by that distance without meeting it, and has met it where the sign changes and the two sizes are no more than the way between.
// Media have the same with medium_<key>_…; inside is negative, and outside positive.

uniform float meeting_reach;  // r_s from the hole, beyond which there is nothing to meet

const int MEETING_NONE = -1;

#each thing : bool kind_$key(int kind) { return kind == THING_$KEY; }
#each medium : bool kind_$key(int kind) { return kind == MEDIUM_$KEY; }

// What was found on a piece of a curve.
struct Found {
    int kind, index;  // MEETING_NONE: nothing
    float before, after;  // parts of the step between which the surface lies
};

float distance_to(int kind, int index, vec3 x) {
#each thing : if (kind_$key(kind)) return thing_$key_distance(index, x);
#each medium : if (kind_$key(kind)) return medium_$key_distance(index, x);
    return 1e30;
}

// How far x is from everything, at least.
float clearance(vec3 x) {
    float least = 1e30;
#each thing : for (int i = 0; i < thing_$key_count; ++i) least = min(least, abs(thing_$key_distance(i, x)));
#each medium : for (int i = 0; i < medium_$key_count; ++i) least = min(least, abs(medium_$key_distance(i, x)));
    return least;
}

// Where on the straight way from x to y a surface of these distances lies, 0…1; 2 where there is none.
float met_at(float from, float to, float way) {
    bool met = (from < 0.0) != (to < 0.0) && abs(from) + abs(to) <= 1.001 * way + 1e-6;
    return met ? abs(from) / max(abs(from) + abs(to), 1e-20) : 2.0;
}

// The first of all that lies between x and y, which are close together.
void meet_between(vec3 x, vec3 y, inout Found found) {
    float way = distance(x, y), first = 1.5, at;
#each thing : for (int i = 0; i < thing_$key_count; ++i) { at = met_at(thing_$key_distance(i, x), thing_$key_distance(i, y), way); if (at < first) { first = at; found.kind = THING_$KEY; found.index = i; } }
#each medium : for (int i = 0; i < medium_$key_count; ++i) { at = met_at(medium_$key_distance(i, x), medium_$key_distance(i, y), way); if (at < first) { first = at; found.kind = MEDIUM_$KEY; found.index = i; } }
}

bool is_opaque(int kind) {
#each thing : if (kind_$key(kind)) return THING_$KEY_OPAQUE == 1;
    return false;
}

vec3 curve_point(Curve curve, float t, out vec3 velocity) {
    vec4 rate, place = curve_place(curve, t, rate);
    vec3 x = place.xyz / place.w;
    velocity = (rate.xyz - x * rate.w) / place.w;
    return x;
}

const int MOST_PROBES = 256;
const float OVERSTEP = 5e-4;   // r_s beyond the clearance: what makes a probe pass through the surface it comes to; things are thicker
const float FAR_END = 1e-3;    // of a step that begins or ends infinitely far away, left out there: a thousand times as far as its other end

// Whether anything may be met on the step, looked at by its ends: not on a way that leads out from beyond everything.
bool may_meet(Path a, Path b) {
    if (a.place.w <= 0.0) return true;
    vec4 start = path_place(a), end = path_place(b);
    vec3 from = start.xyz / start.w;
    bool outwards = end.w <= 0.0 || dot(end.xyz, end.xyz) > dot(from, from) * end.w * end.w;
    if (outwards && dot(from, from) > meeting_reach * meeting_reach) return false;
    if (end.w <= 0.0) return true;
    return clearance(from) <= 1.5 * distance(from, end.xyz / end.w) + OVERSTEP;
}

// The first meeting on the curve between the parts `from` and `to`.
Found next_meeting(Curve curve, float from, float to) {
    Found found = Found(MEETING_NONE, 0, from, from);
    float t = curve.a.place.w <= 0.0 ? max(from, FAR_END) : from;
    float last = curve.b.place.w <= 0.0 ? min(to, 1.0 - FAR_END) : to;
    float most = 1.0;
    vec3 velocity, x = curve_point(curve, t, velocity);
    for (int probe = 0; probe < MOST_PROBES; ++probe) {
        if (t >= last) break;
        float clear = clearance(x);
        bool gone = dot(x, velocity) > 0.0 && dot(x, x) > meeting_reach * meeting_reach;
        float next = gone ? last : min(t + min((0.9 * clear + OVERSTEP) / max(length(velocity), 1e-20), most), last);
        vec3 onward, y = curve_point(curve, next, onward);
        float way = distance(x, y);
        if (!gone && way > clear + 2.0 * OVERSTEP) {
            most = 0.8 * (next - t) * (clear + OVERSTEP) / way;  // the curve runs faster than it did at t: not so far
            continue;
        }
        if (!gone) meet_between(x, y, found);
        found.before = t;
        found.after = next;
        if (found.kind != MEETING_NONE) break;
        most = 1.0;
        t = next;
        x = y;
        velocity = onward;
    }
    return found;
}

// The part of the step at which the surface is met: false position on the curve.
float meeting_root(Curve curve, Found found) {
    vec3 ignored;
    float low = found.before, high = found.after;
    float below = distance_to(found.kind, found.index, curve_point(curve, low, ignored));
    float above = distance_to(found.kind, found.index, curve_point(curve, high, ignored));
    float t = low;
    for (int i = 0; i < 5; ++i) {
        t = mix(low, high, clamp(below / (below - above), 0.02, 0.98));
        float here = distance_to(found.kind, found.index, curve_point(curve, t, ignored));
        if ((here < 0.0) == (below < 0.0)) { low = t; below = here; } else { high = t; above = here; }
    }
    return t;
}

// A ray that begins inside a medium, at a camera there, has gone into it where it begins; one that ends inside has come out where it ends.
void meet_at_an_end(vec3 x, Momentum momentum, bool begins, inout Hits hits) {
#each medium : for (int i = 0; i < medium_$key_count; ++i) if (medium_$key_distance(i, x) < 0.0) add_meeting(hits, MEDIUM_$KEY, i, begins, x, momentum, false);
}

// All that is met on the straight line x + s v, v a unit vector, for 0 < s < s_end, in order. The line crosses the disk's plane at `s_crossing`, if at all, in
// `point`. Returns whether the ray ends on something opaque.
bool meet_along_line(vec3 x, vec3 v, float s_end, float s_crossing, vec2 point, inout Hits hits) {
    // From (x, 1) to infinity in the direction v is one straight step between homogeneous places: s = size t/(1 − t).
    float size = max(length(x), 1.0);
    vec4 a = vec4(x, 1.0), b = vec4(size * v, 0.0);
    Curve line = Curve(Path(a, b - a, vec2(0.0)), Path(b, b - a, vec2(0.0)), 1.0);
    float from = 0.0, to = s_end < 1e29 ? s_end / (size + s_end) : 1.0;
    bool crosses = s_crossing > 0.0 && s_crossing < s_end;
    for (int i = 0; i < 8; ++i) {
        Found found = next_meeting(line, from, to);
        bool none = found.kind == MEETING_NONE;
        vec3 ignored, y = curve_point(line, none ? from : meeting_root(line, found), ignored);
        if (crosses && (none || s_crossing < distance(y, x))) {
            add_crossing(hits, point, momentum_at(vec3(point, 0.0), v));
            crosses = false;
        }
        if (none) return false;
        vec3 before = curve_point(line, found.before, ignored);
        bool enters = distance_to(found.kind, found.index, before) >= 0.0;
        add_meeting(hits, found.kind, found.index, enters, y, momentum_at(y, v), is_opaque(found.kind));
        if (is_opaque(found.kind)) return true;
        from = found.after;
    }
    return false;
}

// The same on the whole way of a ray: it may begin and end inside a medium.
bool meet_on_line(vec3 x, vec3 v, float s_end, float s_crossing, vec2 point, inout Hits hits) {
    meet_at_an_end(x, momentum_at(x, v), true, hits);
    if (meet_along_line(x, v, s_end, s_crossing, point, hits)) return true;
    if (s_end < 1e29) meet_at_an_end(x + s_end * v, momentum_at(x + s_end * v, v), false, hits);
    return false;
}
