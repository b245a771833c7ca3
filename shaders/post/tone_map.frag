#version 330 core
// Radiance → picture: exposure, glow, tone curve, creative gamma, sRGB transfer (IEC 61966-2-1), dither.
#defines
#blocks
#include "common/noise.glsl"

uniform sampler2D radiance;
#if POST_BLOOM
uniform sampler2D glow;
#endif
uniform vec2 target_origin; // lower left pixel of the picture in the target
uniform vec2 target_texel;  // 1 / size of the picture in the target

out vec4 colour;

#if POST_TONE_MAP_REINHARD
// Reinhard et al. 2002, eq. 4, on each channel, white at 16.
vec3 tone_curve(vec3 light) {
    return light * (1.0 + light / 256.0) / (1.0 + light);
}
#elif POST_TONE_MAP_ACES
// K. Narkowicz' rational fit to the ACES reference rendering, "ACES filmic tone mapping curve" (2015).
vec3 tone_curve(vec3 light) {
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
}
#elif POST_TONE_MAP_AGX
// In the manner of T. Sobotka's AgX: colours are drawn towards grey, a sigmoid acts on stops, −10…+6.5 about middle grey 0.18,
// and most of the saturation is given back. The curve x^p/(x^p + b(1−x)^p) is our own: b keeps middle grey where it is, p gives
// it the slope of 2.4 that AgX has there.
vec3 tone_curve(vec3 light) {
    const vec3 WEIGHTS = vec3(0.2126, 0.7152, 0.0722);
    vec3 drawn = mix(light, vec3(dot(light, vec3(1.0 / 3.0))), 0.16);
    vec3 x = clamp((log2(max(drawn, 1e-8) / 0.18) + 10.0) / 16.5, 0.0, 1.0);
    const float POWER = 2.3;
    vec3 rise = pow(x, vec3(POWER)), rest = pow(1.0 - x, vec3(POWER));
    vec3 encoded = rise / (rise + 3.145 * rest);
    vec3 shown = pow(encoded, vec3(2.2));
    return max(mix(vec3(dot(shown, WEIGHTS)), shown, 1.12), 0.0);
}
#else
vec3 tone_curve(vec3 light) {
    return light;
}
#endif

// sRGB code of light^(1/γ). With s = light^(1/(2.4 γ)) the curve is 1.055 s − 0.055, and its straight toe 12.92 s^2.4: a polynomial
// in √s there, good to 3e-6, spares three powers.
vec3 srgb_code(vec3 light) {
    vec3 s = pow(max(light, 1e-12), vec3(1.0 / (2.4 * post_gamma)));
    vec3 root = sqrt(s);
    vec3 toe = 12.92 * s * s * (0.03652286 + root * (1.28840049 - 0.4598776 * root));
    return mix(toe, 1.055 * s - 0.055, step(0.0904934, s));
}

// Noise of triangular distribution, −1…1, for each channel; a fixed function of the pixel.
vec3 dither_noise(uvec2 pixel) {
    uint h = hash_bits(pixel.x + 0x9e3779b1u * hash_bits(pixel.y + 1u));
    return hash_vec3(h) - hash_vec3(hash_bits(h));
}

void main() {
    vec2 pixel = gl_FragCoord.xy - target_origin;
    vec3 light = textureLod(radiance, pixel * target_texel, 0.0).rgb;
#if POST_BLOOM
    light += post_bloom_intensity * textureLod(glow, pixel * target_texel, 0.0).rgb;
#endif
    light = clamp(tone_curve(light * exp2(post_exposure)), 0.0, 1.0);
    vec3 code = srgb_code(light);
#if POST_DITHER
    // One grey level at most, less near black and white, so that both stay clean.
    code += dither_noise(uvec2(pixel)) * min(vec3(1.0 / 255.0), min(code, 1.0 - code));
#endif
    colour = vec4(code, 1.0);
}
