#version 330 core
// Pixel → the observer's ray → hits. Nothing here depends on how things glow.
//
// The ray model is closed (gives trace_ray itself) or differential (common/march.glsl drives it with an integrator and a step control).
// RAYS_LISTED: rays come from a texture of local directions instead of from pixels, one a texel.

#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/rotation.glsl"
#include "common/hermite.glsl"
#include "common/hits.glsl"
#include "common/curve.glsl"
#include "common/hit_map_write.glsl"
#if MEETINGS
#include "common/lowest_bit.glsl"
#include "common/earlier.glsl"
#include "common/matter.glsl"
#instances
#slots thing
#slots medium
#include "common/meetings.glsl"
#endif
#slot ray_model
#if MARCHED
#slot integrator
#slot step_control
#include "common/march.glsl"
#endif

#if RAYS_LISTED
uniform sampler2D listed_rays;
#else
uniform vec3 ray_grid; // pixels from ray to ray, then the pixel of the first
#endif

void main() {
#if RAYS_LISTED
    vec3 local = texelFetch(listed_rays, ivec2(gl_FragCoord.xy), 0).xyz;
#else
    vec2 place = ray_grid.x * (picture_place(gl_FragCoord.xy) - 0.5) + ray_grid.yz + 0.5;
#if MEETINGS && BALLS_KNOWN
    know_balls(place, ray_grid.x > 1.0);
#endif
    vec3 local = pixel_direction(place);
#if !CAMERA_PROJECTION_PERSPECTIVE
    if (!in_projection(place, 4.0)) { // black, as what the hole hides
        Hits none = no_hits(0.0);
        none.fate = CAPTURED;
        store_hits(none);
        return;
    }
#endif
#endif
    store_hits(trace_ray(ray_start(local)));
}
