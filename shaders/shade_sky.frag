#version 330 core
// Hit map → the sky's linear, scene-referred radiance (Rec. 709 primaries), alpha 1. Drawn behind the disk by blending, and
// only where shade_classes.frag found that light comes from the sky.
//
// Contract of a sky (shaders/skies/<key>.glsl):
//   vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy)
//     direction  unit vector in the world, the ray's asymptotic direction;
//     right, up  how it changes from this pixel to the next one to the right and above: the footprint. Its solid angle
//                |right × up| against that of the pixel is the inverse of the lens's magnification. Where the ray map is
//                torn (shadow's edge) a footprint of 1 rad is given: a sky answers that with its average. Any length
//                from 0 up may come; the answer must be finite;
//     energy     E_observer/E_infinity of the light (blue-shift of a low observer); black bodies look T·energy hot and
//                energy⁴ as bright;
//     answer     radiance, averaged over the footprint.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#slot sky

out vec4 radiance;

const float BRIGHTEST = 6.0e4;     // what a half float holds
const float TORN_FOOTPRINT = 1.0;  // rad

void main() {
    Hits hits = fetch_escape(ivec2(gl_FragCoord.xy));
    float escaped = hits.fate == ESCAPED ? 1.0 : 0.0;
    vec3 direction = hits.fate == ESCAPED ? hits.direction : vec3(1.0, 0.0, 0.0);
    vec3 right = block_side * dFdx(hits.direction), up = block_side * dFdy(hits.direction); // of a whole pixel
    bool whole_right = dFdx(escaped) == 0.0, whole_up = dFdy(escaped) == 0.0;

    vec3 torn = TORN_FOOTPRINT * cross(direction, abs(direction.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
    right = whole_right ? right : (whole_up ? cross(up, direction) : torn);
    up = whole_up ? up : cross(direction, right);

    float energy = 1.0 / max(pixel_energy_ratio(pixel_direction(picture_place(gl_FragCoord.xy))), 1e-6);
    vec3 light = escaped * sky_brightness * sky_radiance(direction, right, up, energy);
    radiance = vec4(clamp(light, 0.0, BRIGHTEST), 1.0);
}
