// Where a ray meets the scene's things and media, in order along the curve that it takes; never by jumping.
//
// The curve is cut into pieces that are nearly straight, and each is tested against the boxes round all instances (common/hierarchy.glsl), wider by as much as
// the way strays from the piece. An instance whose box is met is tested itself, once the piece strays by no more than a small share of its size.
//
// A kind of thing (shaders/things/<key>.glsl) or medium (shaders/media/<key>.glsl) tells
//     float thing_<key>_distance(int i, vec3 x)   of instance i: signed, of two signs on the two sides of its surface, and in size at most how far x is
//                                                 from it, in r_s; x in the world
// So one may go on along a piece by that distance without meeting it, and has met it where the sign changes and the two sizes are no more than the way between.
// Media have the same with medium_<key>_…; inside is negative, and outside positive. A thing whose header says meets = "crossing" tells instead
//     float thing_<key>_crossing(int i, vec3 x, vec3 y, out bool enters)   the part 0…1 of the straight piece from x to y at which instance i is first
//                                                 met, and whether it is entered there; 2: not at all
// and with tells_apart, which is for what is made of many parts
//     float thing_<key>_crossing(int i, vec3 x, vec3 y, vec3 bow, float stray, out bool enters, out int part)   the same of a way that bends by `bow` from the piece
//                                                 (common/curve.glsl), and the number of the part that is met, below 2¹⁸; where the way strays from there by more
//                                                 than 0: 2 where it misses it for certain, else less
//     vec3 thing_<key>_facing(int i, int part)   the unit normal of that part
//     float thing_<key>_grain(int i)             how long its parts are at most, r_s
//
// BALLS_KNOWN: coarse rays have told which balls that things lie in may be met where the ray is (common/reach.glsl): those few are held against it instead of the boxes
// of all. All things are opaque then.
#include "common/hierarchy.glsl"
#include "common/disk_plane.glsl"
#if BALLS_KNOWN
#include "common/known_balls.glsl"
#endif

uniform float meeting_reach;        // r_s from the hole, beyond which there is nothing to meet
uniform isampler2D meeting_nodes;   // the hierarchy of all instances; a leaf holds 32·index + kind

const int MEETING_NONE = -1;

#each thing : bool kind_$key(int kind) { return kind == THING_$KEY; }
#each medium : bool kind_$key(int kind) { return kind == MEDIUM_$KEY; }

float distance_to(int kind, int index, vec3 x) {
#each thing_by_distance : if (kind_$key(kind)) return thing_$key_distance(index, x);
#each medium : if (kind_$key(kind)) return medium_$key_distance(index, x);
    return 1e30;
}

bool is_opaque(int kind) {
#each thing : if (kind_$key(kind)) return THING_$KEY_OPAQUE == 1;
    return false;
}

bool tells_distance(int kind) {
#each thing_by_crossing : if (kind_$key(kind)) return false;
    return true;
}

bool tells_apart(int kind) {
#each thing_told_apart : if (kind_$key(kind)) return true;
    return false;
}

bool is_medium(int kind) {
#each medium : if (kind_$key(kind)) return true;
    return false;
}

const int MOST_PROBES = 256;
const int MOST_PIECES = 256;
// How far a piece that a thing is tested against may be from the way, which moves its outline by as much: a share of its size, and never more than so many r_s.
const float STRAY_SHARE = 1e-3, MOST_STRAY = 5e-3;

float stray_allowed(float size) {
    return min(STRAY_SHARE * size, MOST_STRAY);
}

// That of the ball that an instance lies in, r_s.
float size_of(int kind, int index) {
#each thing : if (kind_$key(kind)) return thing_$key_bound(index).w;
#each medium : if (kind_$key(kind)) return medium_$key_bound(index).w;
    return 0.0;
}

const float MOST_GRAIN = 0.5;  // of a piece that is held, as it bends, against parts: beside one of them it goes on straight

// How long the parts of what tells_apart are, r_s.
float grain_of(int kind, int index) {
#each thing_told_apart : if (kind_$key(kind)) return thing_$key_grain(index);
    return 0.0;
}

// What a step passes through the surface that it comes to by, in r_s, of a thing of that size at x: less than things are thick, more than x is rounded by.
float overstep(float size, vec3 x) {
    return min(5e-4, 2e-4 * size) + 1e-6 * length(x);
}

// The part of the piece from x to y at which what tells its distance is met: by steps as long as that.
float traced_part(int kind, int index, float size, vec3 x, vec3 y, out bool enters) {
    float way = distance(x, y), over = overstep(size, x), part = 2.0;
    float s = 0.0, before = distance_to(kind, index, x);
    float rounding = 1e-6 + 3e-7 * length(x);  // of places along it and of distances there
    vec3 along = (y - x) / max(way, 1e-20);
    enters = before >= 0.0;
    for (int i = 0; i < MOST_PROBES; ++i) {
        float next = min(s + 0.9 * abs(before) + over, way), after = distance_to(kind, index, x + next * along);
        bool met = (after < 0.0) != (before < 0.0) && abs(before) + abs(after) <= 1.001 * (next - s) + rounding;
        if (met) {
            part = mix(s, next, abs(before) / max(abs(before) + abs(after), 1e-20)) / max(way, 1e-20);
            break;
        }
        if (next >= way) break;
        s = next;
        before = after;
    }
    return part;
}

#if RAYS_LIGHT_TRAVEL
vec3 centre_of(int kind, int index) {
#each thing : if (kind_$key(kind)) return thing_$key_bound(index).xyz;
#each medium : if (kind_$key(kind)) return medium_$key_bound(index).xyz;
    return vec3(0.0);
}

// By how much the centre of an instance was elsewhere for each r_s/c that light left it earlier.
vec3 earlier_by_delay(int kind, int index, float delay) {
    const float APART = 0.05;
    seen_delay = delay + APART;
    vec3 before = centre_of(kind, index);
    seen_delay = delay - APART;
    vec3 after = centre_of(kind, index);
    seen_delay = delay;
    return (before - after) / (2.0 * APART);
}

// How far the way of an instance between two times bows out from the straight one, r_s.
float circle_bow(int kind, int index, vec2 delays) {
    seen_delay = delays.x;
    vec3 from = centre_of(kind, index);
    seen_delay = delays.y;
    vec3 to = centre_of(kind, index);
    seen_delay = 0.5 * (delays.x + delays.y);
    return distance(centre_of(kind, index), 0.5 * (from + to));
}
#endif

// The part of the piece at which the instance is first met, 0…1; 2: not at all. Where light takes its time the ends of the piece were passed at two times: what moves
// is met where it was in between, which is as if it stood and the piece led farther. `of`: the number of its part, for which the way bends by `bow`. Where it strays by more than 0, what
// tells_apart says whether it is missed for certain (2), and all else that it may be met (0).
float met_part(int kind, int index, float size, vec3 x, vec3 y AND_TIME(vec2 delays), vec3 bow, float stray, out bool enters, out int of) {
    float part = 2.0;
    enters = true;
    of = 0;
#if RAYS_LIGHT_TRAVEL
    seen_delay = delays.y;
    vec3 there = centre_of(kind, index);
    seen_delay = delays.x;
    if (stray <= 0.0) y += centre_of(kind, index) - there;
#endif
#if MEETINGS_BY_DISTANCE
    if (tells_distance(kind) && stray <= 0.0) part = traced_part(kind, index, size, x, y, enters);
#endif
#each thing_not_placed : if (kind_$key(kind)) part = thing_$key_crossing(index, x, y, enters);
#each thing_told_apart : if (kind_$key(kind)) part = thing_$key_crossing(index, x, y, bow, stray, enters, of);
    return tells_apart(kind) || stray <= 0.0 ? part : 0.0;
}

#if BALLS_KNOWN
#define AND_PLACE(x) , x
#else
#define AND_PLACE(x)
#endif

// What was found.
struct Found {
    int kind, index;  // MEETING_NONE: nothing
    float at;         // where: part of a piece, or parameter of a curve
    float size;       // half the width of what was found, r_s
    bool enters;
    int part;         // of what tells_apart
#if BALLS_KNOWN
    vec3 place;       // on the piece that has met it
#endif
};

const Found NOTHING_FOUND = Found(MEETING_NONE, 0, 2.0, 0.0, true, 0 AND_PLACE(vec3(0.0)));

// Meeting has it.
vec3 note_on(Found found) {
    vec3 note = vec3(0.0);
#each thing_told_apart : if (kind_$key(found.kind)) note = float(found.part + 1) * thing_$key_facing(found.index, found.part);
    return note;
}

// Of media only the first that is entered is kept: transfer.frag goes on from there, and finds the others and the ways out itself.
void meet(Found found, vec3 place, Momentum momentum AND_TIME(float delay), inout Hits hits) {
    bool known = false;
    for (int k = 0; k < MEETINGS; ++k) known = known || is_medium(hits.meeting[k].kind);
    if (!is_medium(found.kind) || found.enters && !known) add_meeting(hits, found.kind, found.index, found.enters, place, momentum, note_on(found) AND_TIME(delay), is_opaque(found.kind));
}

// The first that the piece from x to y meets, of all leaves from the node `first` on. `allowed` is how far the way may stray from it: where that is less than
// it does, the piece is too long for what it is near to, and nothing else is told.
#if BALLS_KNOWN
Found first_on_piece(vec3 x, vec3 y, Bend bend, int first, out float allowed) {
    Found found = NOTHING_FOUND;
    float stray = bent_stray(bend);
    uint left = stray < 1e29 ? known_balls : 0u;
    allowed = stray < 1e29 ? 1e30 : 0.1 * stray;
    if (left != 0u) do {
        KnownBall ball;
        bool near;
        do {
            ball = next_ball(left);
            near = comes_near(ball, x + 0.5 * bend.bow, y + 0.5 * bend.bow, 0.5 * length(bend.bow) + bend.off);
        } while (!near && left != 0u);
        if (near) {
            float size = size_of(ball.kind, ball.index);
            float own = max(stray_allowed(size), rounding(x, y));  // no finer than single precision
            if (tells_apart(ball.kind)) own = max(own, unseen_stray(x));
            bool bends = tells_apart(ball.kind) && grain_of(ball.kind, ball.index) < MOST_GRAIN * distance(x, y);
            vec3 bow = bends ? bend.bow : vec3(0.0);
            float off = bends ? bend.off : stray;
            bool fine = off <= own, enters;
            int of;
            float part = met_part(ball.kind, ball.index, size, x, y, bow, fine ? 0.0 : off, enters, of);
            if (!fine && part <= 1.0) allowed = min(allowed, own * (stray / off));
            if (fine && part < found.at) found = Found(ball.kind, ball.index, part, size, enters, of AND_PLACE(mix(x, y, part) + 4.0 * part * (1.0 - part) * bow));
        }
        left = stray > allowed ? 0u : left;
    } while (left != 0u);
    return found;
}
#else
Found first_on_piece(vec3 x, vec3 y AND_TIME(vec2 delays), Bend bend, int first, out float allowed) {
    Found found = NOTHING_FOUND;
    float stray = bent_stray(bend);
    Piece piece = piece_of(lattice_of(meeting_nodes), x, y, vec3(0.0), stray);
    int number = stray < 1e29 ? first : 0;
    allowed = stray < 1e29 ? 1e30 : 0.1 * stray;
    if (number > 0) do {
        Node leaf;
        number = next_leaf(meeting_nodes, piece, number, min(found.at, 1.0), true, leaf);
        if (number > 0) {
            int kind = held(leaf) & 31, index = held(leaf) >> 5;
            float size = size_of(kind, index);
            float own = max(stray_allowed(size), rounding(x, y));  // no finer than single precision
#if RAYS_LIGHT_TRAVEL
            own *= stray / (stray + circle_bow(kind, index, delays));
#endif
            bool fine = stray <= own, enters;
            int of;
            float part = met_part(kind, index, size, x, y AND_TIME(delays), vec3(0.0), fine ? 0.0 : stray, enters, of);
            if (fine || part <= 1.0) allowed = min(allowed, own);
            if (fine && part < found.at) found = Found(kind, index, part, size, enters, of);
            number = stray > allowed ? 0 : next_node(leaf, number, true);
        }
    } while (number > 0);
    return found;
}
#endif

// A ball in which there is nothing to meet: centre and radius in r_s.
const vec4 NOWHERE = vec4(0.0, 0.0, 0.0, -1.0);

// How far the piece's end is at least from what a leaf holds, or what is below another node; in cells.
float room_beside(Node node, Piece piece) {
    vec3 end = piece.x + piece.way;
    float room = distance(end, clamp(end, node.low, node.high));
    return is_leaf(node) ? max(room, distance(end, middle(node)) - half_width(node)) : room;
}

// Whether anything may be met on the way from a to b, one step of the march of length h, and the `first` leaf of which that may be: no piece of the way need look
// at those before. Where it `remembers`, `clear` is what is known from the steps before, and from this one.
bool may_meet(Path a, Path b, float h, const bool remembers, inout vec4 clear, out int first) {
    first = 1;
    if (path_leaves(a, b, meeting_reach)) return false;
    if (min(a.place.w, b.place.w) <= 0.0) return true;
    Stray stray = path_stray(a, b, h);
    vec3 x = path_point(a), y = path_point(b);
#if BALLS_KNOWN
    bool comes = false;
    uint left = known_balls;
    if (left != 0u) do {
        KnownBall ball = next_ball(left);
        comes = comes || comes_near(ball, x + stray.aside, y + stray.aside, stray.moved_off);
    } while (left != 0u);
    return comes || stray.off > 1e29;
#else
    Piece piece = piece_of(lattice_of(meeting_nodes), x + stray.aside, y + stray.aside, vec3(0.0), stray.moved_off);
    bool is_clear = remembers && max(distance(x, clear.xyz), distance(y, clear.xyz)) + stray.off + rounding(x, y) < clear.w;
    bool near = !is_clear && stray.off > 1e29;
    int number = is_clear || near ? 0 : 1;
    float room = 1e30;
    if (number > 0) do {
        Node node = fetch_node(meeting_nodes, number);
        bool met = meets_box(piece, node, 1.0);
        near = met && is_leaf(node) && (!tells_apart(held(node) & 31) || meets_ball(piece, node));  // what is round about fills most of its box
#if MEETINGS_BY_DISTANCE && !RAYS_LIGHT_TRAVEL
        int kind = held(node) & 31, index = held(node) >> 5;
        if (near && tells_distance(kind)) near = abs(distance_to(kind, index, x)) <= distance(x, y) + 2.0 * stray.off + overstep(1.0, x);
#endif
        if (remembers && (!met || is_leaf(node))) room = min(room, room_beside(node, piece));  // no more of the hierarchy is walked to find out
        if (near) first = number;
        number = near ? 0 : next_node(node, number, met);
    } while (number > 0);
    if (remembers && !is_clear) clear = near ? NOWHERE : vec4(y + stray.aside, piece.cell * room);
    return near;
#endif
}

// The parameter between `from` and `to`, at which the curve is at a and b, where it is beside what is the part `part` of the way from a to b: as it would be if places
// were linear in it, and once more by false position.
float parameter_beside(Way way, float from, float to, Path a, Path b, float part) {
    vec3 begin = path_point(a), onward = path_point(b) - begin;
    float t = mix(from, to, part * a.place.w / max(mix(b.place.w, a.place.w, part), 1e-30));
    float whole = dot(onward, onward), beyond = dot(path_point(way_path(way, t)) - begin, onward) - part * whole;
    return beyond < 0.0 ? mix(t, to, beyond / min(beyond - (1.0 - part) * whole, -1e-20)) : mix(t, from, beyond / max(beyond + part * whole, 1e-20));
}

const float FAR_END = 1e-3;    // of a step that begins or ends infinitely far away, left out there: a thousand times as far as its other end

// The first meeting on the curve between its parameters `from` and `to`. A round leaves a way that is done where it is (docs/llvmpipe.md).
Found next_meeting(Way way, float from, float to, int first) {
    float t = way.a.place.w <= 0.0 ? max(from, FAR_END) : from;
    float last = way.b.place.w <= 0.0 ? min(to, 1.0 - FAR_END) : to;
#if BALLS_KNOWN && MEETINGS_TOLD_APART
    vec2 within = within_known(way, t, last);
    t = max(t, within.x);
    last = min(last, within.y);
#endif
    Path here = way_path(way, t), ahead;
    float part = last - t, next;
    Found found;
    bool done;
    int pieces = 0;
    do {
#if BALLS_KNOWN && MEETINGS_TOLD_APART
        next = min(t + part, last);
        ahead = way_path(way, next);
        Bend bend = path_bend(here, way_path(way, 0.5 * (t + next)), ahead);
#else
        next = min(t + part, t < 0.5 ? min(last, 0.5) : last);
        ahead = way_path(way, next);
        Bend bend = no_bend(path_stray(here, ahead, next - t).off);
#endif
#if RAYS_LIGHT_TRAVEL
        bend.off = max(bend.off, 1e-9);  // beside which the bows of circles are measured
#endif
        float stray = bent_stray(bend), allowed;
        found = first_on_piece(path_point(here), path_point(ahead) AND_TIME(vec2(path_delay(here), path_delay(ahead))), bend, first, allowed);
        bool fine = stray <= allowed;
        if (!fine) found = NOTHING_FOUND;
        done = t >= last || fine && (found.kind != MEETING_NONE || next >= last || path_leaves(here, ahead, meeting_reach));
        if (!done) {
            part = fine ? 2.0 * part : (next - t) * clamp(0.9 * sqrt(allowed / stray), 0.1, 0.7);
            t = fine ? next : t;
        }
        if (!done && fine) here = ahead;
    } while (!done && ++pieces < MOST_PIECES);
    if (t >= last) found = NOTHING_FOUND;
    if (found.kind != MEETING_NONE) found.at = parameter_beside(way, t, next, here, ahead, found.at);
    return found;
}

// How far on along the unit vector `onward` from x what tells no distance is met, by which of its parts: looked for as far as `most` before x and behind it; 1e30: it is
// not, or `is_placed`.
float crossing_beyond(inout Found found, vec3 x, vec3 onward, float most) {
    bool enters = found.enters;
    int of = found.part;
    float part = 2.0;
#each thing_not_placed : if (kind_$key(found.kind)) part = thing_$key_crossing(found.index, x - most * onward, x + most * onward, enters);
#if !BALLS_KNOWN
#each thing_told_apart : if (kind_$key(found.kind)) part = thing_$key_crossing(found.index, x - most * onward, x + most * onward, vec3(0.0), 0.0, enters, of);
    if (tells_apart(found.kind) && part <= 1.0) {
        found.enters = enters;
        found.part = of;
    }
#endif
    return part <= 1.0 ? (2.0 * part - 1.0) * most : 1e30;
}

// Whether what was found is where the piece has it: what tells_apart may be displaced in a picture that moves by as much as a piece of its way strays.
bool is_placed(Found found) {
#if BALLS_KNOWN
    return tells_apart(found.kind);
#else
    return false;
#endif
}

// How far a surface may be from where a curve has it, so that a straight way leads there; r_s.
float straight_reach(float size, vec3 x) {
    return 4.0 * stray_allowed(size) + 1e-5 * length(x);
}

// How far on along the unit vector `onward` from x, which is close to it, the surface of what was found lies, r_s; 1e30 where that is more than `most`.
float beyond_surface(inout Found found, vec3 x, vec3 onward, float most) {
    float beyond = 1e30;
#if MEETINGS_BY_DISTANCE
    if (tells_distance(found.kind)) {
        float probe = 1e-3 * min(found.size, 1.0) + 1e-5 * length(x);
        beyond = 0.0;
        for (int i = 0; i < 3; ++i) {  // Newton's method
            float off = distance_to(found.kind, found.index, x + beyond * onward);
            float slope = (distance_to(found.kind, found.index, x + (beyond + probe) * onward) - off) / probe;
            beyond = abs(slope) < 1e-6 ? 1e30 : clamp(beyond - off / slope, -2.0 * most, 2.0 * most);
        }
    }
#endif
    if (!tells_distance(found.kind)) beyond = crossing_beyond(found, x, onward, most);
    return abs(beyond) <= most ? beyond : 1e30;
}

// A ray that begins inside a medium, at a camera there, has gone into it where it begins.
void meet_at_start(vec3 x, Momentum momentum, inout Hits hits) {
#each medium : for (int i = 0; i < medium_$key_count; ++i) if (medium_$key_distance(i, x) < 0.0) meet(Found(MEDIUM_$KEY, i, 0.0, 0.0, true, 0 AND_PLACE(x)), x, momentum AND_TIME(0.0), hits);
}

#if !RAYS_LIGHT_TRAVEL  // models of straight rays tell no times
// All that is met on the straight line x + s v, v a unit vector, for 0 < s < s_end, in order. The line crosses the disk's plane at `s_crossing`, if at all, in
// `point`. Returns whether the ray ends on something opaque.
bool meet_along_line(vec3 x, vec3 v, float s_end, float s_crossing, vec2 point, inout Hits hits) {
    float along = -dot(x, v), beside2 = dot(x, x) - along * along;
    float leaves = along + sqrt(max(meeting_reach * meeting_reach - beside2, 0.0));  // what lies beyond is out of reach
    float from = 0.0, last = max(min(s_end, leaves), 0.0);
    bool crosses = s_crossing > 0.0 && s_crossing < s_end;
    for (int i = 0; i < 8; ++i) {
        float ignored;
        Found found = first_on_piece(x + from * v, x + last * v, no_bend(0.0), 1, ignored);
        bool none = found.kind == MEETING_NONE || from >= last;
        float s = mix(from, last, found.at);
        if (crosses && (none || s_crossing < s)) {
            add_crossing(hits, point, momentum_at(disk_place(point), v));
            crosses = false;
        }
        if (none) return false;
        vec3 y = x + s * v;
        meet(found, y, momentum_at(y, v), hits);
        if (is_opaque(found.kind)) return true;
        from = s + 2.0 * overstep(found.size, y);
    }
    return false;
}

// The same on the whole way of a ray: it may begin inside a medium.
bool meet_on_line(vec3 x, vec3 v, float s_end, float s_crossing, vec2 point, inout Hits hits) {
    meet_at_start(x, momentum_at(x, v), hits);
    return meet_along_line(x, v, s_end, s_crossing, point, hits);
}
#endif
