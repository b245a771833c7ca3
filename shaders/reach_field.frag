#version 330 core
// Coarse rays in a field → what becomes of each, and to which balls in space it comes as near as the rays beside it are away (common/reach.glsl): the straight way
// in, reach_steps steps within the field's sphere, of which it is looked at reach_stride at once, the straight way out. It ends on nothing, but where all of
// its quad are hidden.
#defines
#blocks
#include "common/constants.glsl"
#include "common/lowest_bit.glsl"
#include "common/observer.glsl"
#include "common/rotation.glsl"
#include "common/hermite.glsl"
#include "common/hits.glsl"
#include "common/curve.glsl"
#slot ray_model
#slot integrator
#slot step_control
#include "common/march.glsl"
#include "common/reach.glsl"

uniform int reach_steps, reach_stride;
uniform float reach_step; // pixels from ray to ray
uniform vec2 reach_first; // texel of the first

out uvec2 node;

// Stands for the fate of a ray that passes the sphere by: at its rim the rays beside it break off.
const int PASSED_BY = CAPTURED;

// The spot at which the straight way on from `here` leaves the shell in which all balls lie; the nearest to its middle where it never is in it.
Spot straight_end(Spot here) {
    vec3 v = normalize(here.rate);
    float along = -dot(here.x, v), inside = reach_radii.y * reach_radii.y - dot(here.x, here.x) + along * along;
    return Spot(here.x + max(along + sqrt(max(inside, 0.0)), 0.0) * v, v);
}

void main() {
    vec2 pixel = reach_step * (gl_FragCoord.xy - reach_first - 0.5) + 0.5;
    RayStart start = ray_start(pixel_direction(pixel));
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    March m = march_start(orbit, ray_init(start, orbit, hits));
    Path path = ray_path(orbit, m.s);
    Spot here = spot_of(path), camera = Spot(start.n * (0.5 / start.w), here.rate);
    Margin margin = reach_margin(here);
    Reached reached = balls_near(camera, here, margin_about(0.0), margin);
    int fate = orbit.bends > 0.0 ? UNRESOLVED : PASSED_BY;
    int steps = 0;
    do {
        bool was_under_way = fate == UNRESOLVED;
        Spot before = here;
        int done = 0;
        do {
            march_once(orbit, m);
            Path old = path;
            path = ray_path(orbit, m.next);
            bool under_way = fate == UNRESOLVED, leaves = m.fate == ESCAPED;
            if (under_way) here = spot_of(leaves ? curve_path(Curve(old, path, m.h), ray_end(orbit, m.s, m.next, m.h)) : path);
            fate = under_way && leaves ? ESCAPED : fate;
        } while (++done < reach_stride);
        Margin margin_before = margin;
        margin = reach_margin(here);
        Reached found = balls_near(before, here, margin_before, margin);
        if (was_under_way) reached = reached_on(reached, found);
        steps += reach_stride;
    } while (steps < reach_steps && any_of_quad(fate == UNRESOLVED) && any_of_quad(reached.hidden == 0u));
    if (fate == UNRESOLVED && reached.hidden > 0u) fate = ESCAPED;  // what lies behind the ball is no matter
    Spot end = straight_end(here);
    Reached onward = balls_near_straight(reached, here, end, margin, reach_margin(end));
    if (fate != UNRESOLVED) reached = onward;
    node = packed_node(fate, reached);
}
