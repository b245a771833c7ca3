// Whether coarse rays, side by side, come so near to balls in space that one between them may meet it.
//
// Neighbours take steps of like length, so after as many steps they are about as far on their ways, and what is between them across the way is how far apart
// they are there: the margin by which a ray may miss a ball. It is a difference between the fragments of a quad, so a ray takes steps as long as any of its quad,
// if it has ended too. Rays end where they leave the shell between reach_radii, in which all balls lie: there neighbours end alike, whatever step it is in.
//
// That margin holds for each ray by itself. Four rays that all miss a ball by less tell as much where it is wider than they are apart: it can come between two of them by
// no more than its edge bows there, and what is not linear between them. It is then near to none of them, and only the cell between them says whether that can be trusted
// (refine_cells.frag). And four rays that are all in a ball, if only by what is not linear, have none between them that is not.
//
// A ball that a thing fills hides what lies behind it, once a ray is deeper in it than the margin: the rays beside it are in it, too.
#include "common/reach_node.glsl"

// A column each: centre in r_s, in the plan's frame, and radius, negative where a thing fills it; then 1 + kind + 32·index of what lies in it.
uniform sampler2D reach_balls;
uniform int reach_count;       // one at least
uniform float reach_not_linear; // of the margin, for what is not linear between four rays; 1 or more: each has the margin to itself
uniform vec2 reach_radii;      // r_s from the hole: nothing is met nearer than the first, or farther than the second

// How far a cubic may be from the way, of the piece's length, by the sum of the slopes at its ends: where it bends much, as far as the cubic bows.
float roughness(float slopes) {
    return 0.15 * slopes * min(0.25 * slopes, 1.0);
}

// Where a ray is, in r_s, and how fast it moves, by any parameter.
struct Spot {
    vec3 x, rate;
};

Spot spot_of(Path path) {
    return Spot(path_point(path), path_velocity(path));
}

vec3 across(vec3 d, vec3 along) {
    return d - dot(d, along) * along;
}

// How far the rays nearest to this one of four are from it at a spot, across the way, r_s.
struct Margin {
    vec3 right, up;  // to the next rays
    float most;      // to the farthest between the four, half a diagonal away, and a tenth for what is not linear
    float least;     // that tenth; or all of it where directions are not known
};

// To be called by all of a quad.
Margin reach_margin(Spot spot) {
    vec3 along = normalize(spot.rate), right = across(dFdx(spot.x), along), up = across(dFdy(spot.x), along);
    float half_diagonal = 0.5 * max(length(right + up), length(right - up));
    return Margin(right, up, 1.1 * half_diagonal, 0.1 * half_diagonal);
}

// That of a place the part `part` of the way between two.
Margin margin_between(Margin a, Margin b, float part) {
    return Margin(mix(a.right, b.right, part), mix(a.up, b.up, part), mix(a.most, b.most, part), mix(a.least, b.least, part));
}

// The same whatever the direction.
Margin margin_about(float most) {
    return Margin(vec3(0.0), vec3(0.0), most, most);
}

// Square of the longer of the two ways to the next rays.
float longest2(Margin margin) {
    return max(dot(margin.right, margin.right), dot(margin.up, margin.up));
}

// By how much a ray between the four may be nearer to what lies in the direction of the unit vector `towards`: what lies across that leads away from a ball.
float margin_towards(Margin margin, vec3 towards) {
    return margin.least + 0.5 * (abs(dot(margin.right, towards)) + abs(dot(margin.up, towards)));
}

// Whether it holds for any of the quad, which may leave a loop together alone: differences are taken in it.
bool any_of_quad(bool one) {
    float row = float(one);
    row = max(row, abs(dFdx(row)));
    return max(row, abs(dFdy(row))) > 0.0;
}

// Slope of a way against its chord, along the unit vector `along`.
vec3 slope_against(vec3 velocity, vec3 along) {
    float onward = dot(velocity, along);
    return (velocity - onward * along) / max(onward, 0.2 * length(velocity));
}

// Ball number i: centre and radius.
vec4 reach_ball(int i) {
    return textureLod(reach_balls, vec2((float(i) + 0.5) / float(textureSize(reach_balls, 0).x), 0.25), 0.0);
}

// The balls that a piece of a way with its middle at `middle` may be near to: all that are no farther from there than `room`.
uint balls_about(vec3 middle, float room) {
    uint found = 0u;
    int i = 0;
    do {
        vec4 ball = reach_ball(i);
        vec3 off = ball.xyz - middle;
        float within = abs(ball.w) + room;
        found |= dot(off, off) <= within * within ? 1u << i : 0u;
    } while (++i < reach_count);
    return found;
}

// The balls to which the way from a to b comes as near as the margin, which is `begin` at a and `end` at b, and as near as four rays may that have it between them. It
// bows from its chord by a cubic, which rates by any parameter tell: where it still comes nearer at the chord's nearest place, by as much more as such a bow can.
//
// Where directions are not known, as the way turns much or falls into the hole, the margin is not what lies between rays but by how much the way may be off: a share of it
// will not do then.
//
// What is asked of each ball is dear, and few are near. With the slopes s at both ends together the way is no farther from its chord's middle than (1/2 + s/4) of its
// size, and what counts as near is no farther from the way than 0.15 s of it for what is no cubic, (1 + s)/4 for what comes nearer, and 1.4 of the widest margin.
Reached balls_near(Spot a, Spot b, Margin begin, Margin end) {
    vec3 chord = b.x - a.x;
    float size = max(length(chord), 1e-20);
    vec3 along = chord / size, before = slope_against(a.rate, along), after = slope_against(b.rate, along);
    float slopes = length(before) + length(after), rough = size * roughness(slopes);
    vec2 sides2 = vec2(longest2(begin), longest2(end));
    bool directed = begin.least < begin.most;
    Reached found = NONE_REACHED;
    uint left = balls_about(a.x + 0.5 * chord, size * (0.75 + 0.65 * slopes) + 1.4 * max(begin.most, end.most));
    if (left != 0u) do {
        int i = lowest_bit(left);
        vec4 ball = reach_ball(i);
        float radius = abs(ball.w);
        vec3 arm = ball.xyz - a.x;
        float u = clamp(dot(arm, along) / size, 0.0, 1.0);
        vec3 away = arm - size * u * (along + (1.0 - u) * ((1.0 - u) * before - u * after));
        float part = min(u + radius / size, 1.0), far = length(away);
        vec3 towards = away / max(far, 1e-20);
        float most = mix(begin.most, end.most, part);
        float room = mix(margin_towards(begin, towards), margin_towards(end, towards), part);
        float edge_bow = 0.125 * mix(sides2.x, sides2.y, part) / max(radius, 1e-20);
        bool shares = directed && radius > most;
        float between = shares ? min(room, reach_not_linear * most + edge_bow) : room;
        float slope = dot(along + (1.0 - u) * (1.0 - 3.0 * u) * before - u * (2.0 - 3.0 * u) * after, towards);
        float nearing = u <= 0.0 ? max(slope, 0.0) : u >= 1.0 ? max(-slope, 0.0) : abs(slope);
        float misses = far - radius - rough, nearer = nearing * min(0.5 * nearing * far, 0.25 * size);
        found.near |= misses <= room ? 1u << i : 0u;
        found.between |= misses - nearer <= between ? 1u << i : 0u;
        found.hidden = far + rough + most < -ball.w ? uint(i + 1) : found.hidden;
        found.holds = far + rough + (shares ? reach_not_linear * most : most) < -ball.w ? uint(i + 1) : found.holds;
        left = without_lowest(left);
    } while (left != 0u);
    return found;
}

// With what was `reached` before, the same of a straight way, on which the margin grows evenly: in pieces of which each is twice as long as the one before, as all of a
// piece is given what there is at its end. A long way out of a lens begins where rays are close together.
Reached balls_near_straight(Reached reached, Spot a, Spot b, Margin begin, Margin end) {
    const int PIECES = 5;
    Spot before = a;
    Margin margin = begin;
    int done = 0;
    do {
        float part = float((2 << done) - 1) / float((1 << PIECES) - 1);
        Spot after = Spot(mix(a.x, b.x, part), b.rate);
        Margin margin_after = margin_between(begin, end, part);
        reached = reached_on(reached, balls_near(before, after, margin, margin_after));
        before = after;
        margin = margin_after;
    } while (++done < PIECES && reached.hidden == 0u);
    return reached;
}
