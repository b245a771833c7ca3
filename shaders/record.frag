#version 330 core
// Listed rays, each as far as a number of steps takes it: the way of a ray through space, by the steps of the march that pictures are traced with.
// For marched models alone. A texel of `listed_rays` is a local direction and the way: whole steps, or a part of the last one.

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

uniform sampler2D listed_rays;

layout(location = 0) out vec4 place_out;  // homogeneous (common/curve.glsl), in the plan's frame
layout(location = 1) out vec4 step_out;   // of the last step: its own error, the drift of what is conserved (−1 for none), what became of the ray, length

// By how much the last step differs from two of half its length, about an angle in radians: the error that it adds.
float step_error(Orbit orbit, March m) {
    State halves = march_step(orbit, march_step(orbit, m.s, 0.5 * m.h), 0.5 * m.h);
    return state_difference(orbit, march_step(orbit, m.s, m.h), halves);
}

void main() {
    vec4 asked = texelFetch(listed_rays, ivec2(gl_FragCoord.xy), 0);
    RayStart start = ray_start(asked.xyz);
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    March m = march_start(orbit, ray_init(start, orbit, hits));
    int whole = int(ceil(asked.w));
    while (m.steps < whole) {
        march_once(orbit, m);
        if (m.fate != UNRESOLVED) break;  // a second way out: docs/llvmpipe.md
    }
    float part = min(asked.w - float(whole - 1), march_end(orbit, m));
    State there = m.next;
    if (whole > 0 && part < 1.0) there = march_step(orbit, m.s, m.h * part);
    float drift = -1.0;
#ifdef RAY_DRIFT
    drift = RAY_DRIFT(orbit, there);
#endif
    place_out = path_place(ray_path(orbit, there));
    step_out = vec4(step_error(orbit, m), drift, float(m.fate), m.h);
}
