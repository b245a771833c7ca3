#version 330 core
// Rays at every REACH_STEP-th pixel → where they end, and how far apart the rays about them would have to end to meet one of the balls that things lie in
// (common/reach.glsl): for reach_cells.frag. They end on no thing and look for no crossing.
#defines
#blocks
#include "common/constants.glsl"
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

out vec4 node; // direction in which it ends, or from the hole where that takes it; fate, and a quarter of the least angle

void main() {
    vec2 pixel = float(REACH_STEP) * (gl_FragCoord.xy - 1.5) + 0.5; // the first node lies one step outside the picture
    RayStart start = ray_start(pixel_direction(picture_place(pixel)));
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    March m = march_start(orbit, ray_init(start, orbit, hits));
    march_once(orbit, m);
    Reach reach = reach_start(Curve(ray_path(orbit, m.s), ray_path(orbit, m.next), m.h));
    while (m.steps < plan_max_steps) {
        reach_step(Curve(ray_path(orbit, m.s), ray_path(orbit, m.next), m.h), min(march_end(orbit, m), 1.0), reach);
        if (m.fate != UNRESOLVED) break;
        march_once(orbit, m);
    }
    if (m.fate == ESCAPED) ray_finish(orbit, march_step(orbit, m.s, m.h * march_end(orbit, m)), hits);
    node = vec4(m.fate == CAPTURED ? reach.captured : hits.direction, float(m.fate) + 0.25 * reach.least);
}
