#version 330 core
// Radiance → picture: glow, exposure and tone curve by table, dither.
#defines
#blocks
#include "common/tone_table.glsl"
#include "common/tone.glsl"
#include "common/developed.glsl"
#include "common/lensed_picture.glsl"
#include "common/heat.glsl"
#if !CAMERA_PROJECTION_PERSPECTIVE
#include "common/observer.glsl"
#endif

uniform sampler2D radiance;    // filtered linearly where the picture has another size; else not: docs/llvmpipe.md, texels
#if POST_COLOURS_AFMHOT
uniform sampler2D brightest; // one texel: the luminance of the brightest pixel
#elif POST_BLOOM
uniform sampler2D glow;
#endif
uniform vec2 target_origin; // lower left pixel of the picture in the target
uniform vec2 target_texel;  // 1 / size of the picture in the target
uniform vec4 light_window;  // from a place in the picture, 0…1, to that in `radiance`, which may hold a part of it: scale, shift
uniform vec4 glow_window;   // the same for `glow`

out vec4 colour;

// Noise of triangular distribution, −1…1, for each channel; a fixed function of the pixel. The difference of two gradient noises
// (J. Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", SIGGRAPH 2014), each shifted from channel to channel:
// evenly spread over any few pixels, and a quarter of the cost of hashed bits.
vec3 dither_noise(vec2 pixel) {
    const vec2 GRADIENT = vec2(0.06711056, 0.00583715);
    vec2 even = fract(52.9829189 * fract(vec2(dot(pixel, GRADIENT), dot(pixel, GRADIENT.yx))));
    return fract(even.x + vec3(0.0, 1.0, 2.0) / 3.0) - fract(even.y + vec3(2.0, 0.0, 1.0) / 3.0);
}

void main() {
    vec2 pixel = gl_FragCoord.xy - target_origin, place = pixel * target_texel;
#if POST_LENS
    vec3 hole = from_hole(place);
    place = lensed_place(place, hole);
#endif
    vec3 light = textureLod(radiance, place * light_window.xy + light_window.zw, 0.0).rgb;
#if POST_BLOOM && !POST_COLOURS_AFMHOT
    light += post_bloom_intensity * textureLod(glow, place * glow_window.xy + glow_window.zw, 0.0).rgb;
#endif
#if POST_LENS
    light *= lens_cover(hole);
#endif
#if POST_COLOURS_AFMHOT
    vec3 code = heat(luminance(light) / max(texelFetch(brightest, ivec2(0), 0).r, 1e-12));
#else
    vec3 code = developed(light);
#endif
#if POST_LENS && POST_LENS_RING
    code = mix(code, vec3(0.25, 0.9, 0.45), lens_ring(hole));
#endif
#if POST_DITHER
    // One grey level at most, less near black and white, so that both stay clean.
    code += dither_noise(pixel) * min(vec3(1.0 / 255.0), min(code, 1.0 - code));
#endif
#if !CAMERA_PROJECTION_PERSPECTIVE
    if (!in_projection(pixel * target_texel * picture_size, 0.0)) code = vec3(0.0); // no glow beyond the rim
#endif
    colour = vec4(code, 1.0);
}
