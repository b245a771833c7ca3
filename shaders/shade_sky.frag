#version 330 core
// Hit map → the sky's linear, scene-referred radiance (Rec. 709 primaries). Drawn behind the disk by blending, and
// only where shade_classes.frag found that light comes from the sky. Alpha: 1 where star_layer.frag has a star to draw, −1 where it may have several, else 0.
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
//   A sky with points of light in it, which a picture that is drawn coarse and shown enlarged would smear, says in its header how many there may be in a
//   pixel (`stars = 4`), SKY_STARS here. Instead it has
//     vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy, float finer, out float stars_near)
//       finer       1, or side of a pixel shown over the pixel's. Below 1 the points that can be seen singly with the footprint of a pixel shown are left
//                   out;
//       stars_near  how many of them are within 0.72 pixels of the middle;
//     float sky_kernel(float away2)
//       answer      how a point's light falls off (common/star_light.glsl);
//     SkyStars sky_stars(vec3 direction, vec3 right, vec3 up, float finer)
//       right, up   of a pixel shown;
//       answer      a struct of the sky's own: those near, `count` of them at most, 1 to SKY_STARS;
//     SkyStars sky_stars_at(SkyStars stars, vec3 direction, vec3 right, vec3 up, float finer)
//       answer      the same, as bright as they are seen singly in that footprint;
//     vec3 sky_star(SkyStars stars, int n, float energy, out vec4 star)
//       answer      the light of point n < count, radiance × sr, 0 where it is not there;
//       star        unit vector to it, and its radius in rad.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/sky_beaming.glsl"
#slot sky

#if SKY_STARS
uniform float finer;
#endif

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

    vec2 energy = pixel_energies(pixel_direction(picture_place(gl_FragCoord.xy)));
#if SKY_STARS
    float stars_near;
    vec3 light = escaped * sky_brightness * sky_beaming(energy) * sky_radiance(direction, right, up, energy.x, finer, stars_near);
    radiance = vec4(clamp(light, 0.0, BRIGHTEST), escaped * (stars_near < 1.5 ? stars_near : -1.0));
#else
    vec3 light = escaped * sky_brightness * sky_beaming(energy) * sky_radiance(direction, right, up, energy.x);
    radiance = vec4(clamp(light, 0.0, BRIGHTEST), 0.0);
#endif
}
