#version 330 core
// What rays of a coarse grid have gone through → for each of its cells, by its lower left ray: the fate that its four rays share, and SEEN more where any meets a medium, if they have one and the same history
// (fate, surfaces of media, crossings of the disk's plane; where none of these is near the disk it makes no difference how many there are) and light that does not bend too much between them; else below 0.
// For transfer_marks.frag.
#defines
#blocks
#include "common/constants.glsl"

uniform sampler2D gathered0, dimmed0;  // of the grid; alpha: the pieces of the ray that lie in media, and its history

out float cell;

// What a surface, a crossing of the disk's plane and one near the disk add to a history; below that is its fate.
const float ONE_SURFACE = 8.0, ONE_CROSSING = 256.0, NEAR_DISK = 1024.0, SEEN = 8.0;

// As a way through a medium grows from nothing, light that only surfaces part goes from ray to ray without a jump, but with a bend. How much the four may differ there: in light as exposed, and in
// the share that they take; interpolated light is off by a quarter of that at most.
const float LEAST_SEEN = 0.02, LEAST_TAKEN = 0.15;

vec4 texel(sampler2D grid, ivec2 ray) {
    return texelFetch(grid, min(ray, textureSize(grid, 0) - 1), 0);
}

float spread(vec3 a, vec3 b, vec3 c, vec3 d) {
    vec3 most = max(max(a, b), max(c, d)) - min(min(a, b), min(c, d));
    return max(max(most.x, most.y), most.z);
}

uniform float most_bent;  // of light from ray to ray, against how bright it is there: between two of three, linear interpolation is off by an eighth of what they bend

const float FAINT = 0.1;  // light as exposed of which less is not worth a ray

float bend(ivec2 ray, ivec2 aside) {
    vec3 a = texel(gathered0, max(ray - aside, 0)).rgb, b = texel(gathered0, ray).rgb, c = texel(gathered0, ray + aside).rgb, most = max(max(a, b), c);
    vec3 bent = abs(a - 2.0 * b + c) / (most + FAINT * exp2(-post_exposure));
    return max(max(bent.x, bent.y), bent.z);
}

float bends(ivec2 ray) {
    return max(bend(ray, ivec2(1, 0)), bend(ray, ivec2(0, 1)));
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    vec4 gains0 = texel(gathered0, ray), gains1 = texel(gathered0, ray + ivec2(1, 0)), gains2 = texel(gathered0, ray + ivec2(0, 1)), gains3 = texel(gathered0, ray + 1);
    vec4 takes0 = texel(dimmed0, ray), takes1 = texel(dimmed0, ray + ivec2(1, 0)), takes2 = texel(dimmed0, ray + ivec2(0, 1)), takes3 = texel(dimmed0, ray + 1);
    vec4 four = vec4(takes0.a, takes1.a, takes2.a, takes3.a);
#if ORDERS == 0  // all light is that of one stretch
    bool close = exp2(post_exposure) * spread(gains0.rgb, gains1.rgb, gains2.rgb, gains3.rgb) < LEAST_SEEN && spread(takes0.rgb, takes1.rgb, takes2.rgb, takes3.rgb) < LEAST_TAKEN;
    four = close ? mod(four, vec4(ONE_SURFACE)) : four;
#endif
    four = mod(four, vec4(all(lessThan(four, vec4(NEAR_DISK))) ? ONE_CROSSING : NEAR_DISK));
    float seen = gains0.a + gains1.a + gains2.a + gains3.a > 0.0 ? SEEN : 0.0;
    bool bent = max(max(bends(ray), bends(ray + ivec2(1, 0))), max(bends(ray + ivec2(0, 1)), bends(ray + 1))) > most_bent;
    cell = !bent && four.yzw == four.xxx ? mod(four.x, ONE_SURFACE) + seen : -1.0;
}
