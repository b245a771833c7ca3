#version 330 core
// Rays at every reach_step-th pixel → what becomes of them, and whether they come near any of the balls that things lie in (common/reach.glsl): for
// reach_cells.frag. They end on no thing and look for no crossing; those that take more than reach_steps are given up.
// REACH_PARTS: parts of things count, where these have many (common/reach_parts.glsl).
#defines
#blocks
#include "common/constants.glsl"
#include "common/lowest_bit.glsl"
#include "common/observer.glsl"
#include "common/rotation.glsl"
#include "common/hermite.glsl"
#include "common/hits.glsl"
#include "common/curve.glsl"
#include "common/disk_plane.glsl"
#if REACH_PARTS
#include "common/earlier.glsl"
#include "common/matter.glsl"
#instances
#slots thing
#include "common/meetings.glsl"
#endif
#slot ray_model
#slot integrator
#slot step_control
#include "common/march.glsl"
#include "common/reach.glsl"
#if REACH_PARTS
#include "common/reach_parts.glsl"
#endif

uniform int reach_steps;
uniform float reach_step; // pixels from ray to ray
uniform vec2 reach_first; // texel of the first

out uvec2 node;

const int PIECES = 4; // of a step that is no cubic in space

// Cosine of how far a way turns at most, so that what lies beside it is between what lies beside its ends.
const float STRAIGHT = 0.9;

// What is met in such a step into the hole is found on a curve that may leave the ray by this share of the distance from it (common/curve.glsl).
const float BENT = 0.5, BENT_WITHIN = 1.5;

// A step from a to b is a cubic before the twist and before the division by w.
bool is_bent(Path a, Path b, Spot from, Spot to) {
    float r2 = dot(from.x, from.x), end2 = dot(to.x, to.x);
    return abs(b.twist.x - a.twist.x) > 0.5 || max(r2, end2) > 16.0 * min(r2, end2);
}

// Where the ray is when it has taken the part t of its last step.
Spot spot_at(Orbit orbit, March m, float t) {
    return spot_of(ray_path(orbit, march_step(orbit, m.s, t * m.h)));
}

bool is_outward(Path path) {
    return dot(path.place.xyz, path.rate.xyz) * path.place.w > dot(path.place.xyz, path.place.xyz) * path.rate.w;
}

// The part of the step from a to b at which the ray is as far from the hole as `radius`, or its end, and the spot there.
float part_at(Orbit orbit, March m, Path a, Path b, float radius, out Spot spot) {
    float before = beyond(a.place, radius), after = beyond(b.place, radius);
    bool passes = before * after < 0.0;
    float t = passes ? before / (before - after) : b.place.w > 0.0 ? 1.0 : 0.5 * a.place.w / (a.place.w - b.place.w);
    spot = spot_at(orbit, m, t);
    float r = length(spot.x), slip = passes ? clamp(r * r * (1.0 - r / radius) / dot(spot.x, spot.rate), -0.2 * m.h, 0.2 * m.h) : 0.0;
    spot.x += slip * spot.rate;
    if (passes) spot.x *= radius / length(spot.x);
    return t + slip / m.h;
}

void main() {
    vec2 pixel = reach_step * (gl_FragCoord.xy - reach_first - 0.5) + 0.5;
    RayStart start = ray_start(pixel_direction(pixel));
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    State first = ray_init(start, orbit, hits);
    March m = march_start(orbit, first);
    Path path = ray_path(orbit, m.s);
    Spot here = spot_of(path);
    Margin margin = reach_margin(here);
    int fate = UNRESOLVED;
    Reached reached = NONE_REACHED;
    int steps = 0;
#if REACH_PARTS
    NearParts parts = NO_PARTS;
#endif
    do {
        march_once(orbit, m);
        Path old = path;
        path = ray_path(orbit, m.next);
        bool leaves = beyond(path.place, reach_radii.y) > 0.0 && is_outward(path), falls = path.place.w > 0.0 && beyond(path.place, reach_radii.x) < 0.0;
        Spot end, before = here;
        float part = part_at(orbit, m, old, path, falls ? reach_radii.x : leaves ? reach_radii.y : 1e30, end);
        bool under_way = fate == UNRESOLVED;
        if (under_way) here = end;
        Margin margin_before = margin;
        margin = reach_margin(here);
        int pieces = under_way && is_bent(old, path, before, here) ? PIECES : 1, done = 0;
        float way = distance(before.x, here.x);
        vec3 begun = before.x, begun_rate = before.rate;
        do {
            Spot after = spot_at(orbit, m, float(done + 1) / float(pieces) * part);
            if (done + 1 == pieces) after = here;
            vec2 gone = min(vec2(distance(begun, before.x), distance(begun, after.x)) / max(way, 1e-20), 1.0);
            vec2 margins = mix(vec2(margin_before.most), vec2(margin.most), gone) + (falls ? BENT * min(length(after.x), BENT_WITHIN) : 0.0);
            Margin begin = margin_before, finish = margin;
            bool turns = falls || dot(normalize(begun_rate), normalize(here.rate)) < STRAIGHT;
            if (pieces > 1) begin = turns ? margin_about(margins.x) : margin_between(margin_before, margin, gone.x);
            if (pieces > 1) finish = turns ? margin_about(margins.y) : margin_between(margin_before, margin, gone.y);
            Reached found = balls_near(before, after, begin, finish);
            if (under_way) reached = reached_on(reached, found);
#if REACH_PARTS
            uint seen = under_way ? (found.near | found.between) & reach_parted : 0u;
            parts = near_parts_on(parts, seen, pieces == 1 && !falls, steps, leaves ? part : 1.0, begin.most, finish.most);
#endif
            before = after;
        } while (++done < pieces);
        fate = under_way ? (leaves ? ESCAPED : falls ? CAPTURED : UNRESOLVED) : fate;
    } while (++steps < reach_steps && any_of_quad(fate == UNRESOLVED) && any_of_quad(reached.hidden == 0u));
    if (fate == UNRESOLVED && reached.hidden > 0u) fate = ESCAPED;  // what lies behind the ball is no matter
#if REACH_PARTS
    uint missed = parts.balls & ~near_to_parts(orbit, first, parts);
    reached.near &= ~missed;
    reached.between &= ~missed;
#endif
    node = packed_node(fate, reached);
}
