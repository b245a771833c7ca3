// Exposed light → the screen's code, 0…1: tone curve, creative gamma, sRGB transfer (IEC 61966-2-1).
//
// A curve is three functions, so that the dear part, of one channel alone, can be looked up (post/tone_table.frag):
//   tone_mixed    mixes channels of the light, linearly;
//   tone_channel  the curve of one channel;
//   tone_unmixed  mixes what it gave, linearly. Where nothing is mixed, TONE_MIXES is 0.

#if POST_TONE_MAP_AGX
// In the manner of T. Sobotka's AgX: colours are drawn towards grey, a sigmoid acts on stops, −10…+6.5 about middle grey 0.18,
// and most of the saturation is given back. The curve x^p/(x^p + b(1−x)^p) is our own: b keeps middle grey where it is, p gives
// it the slope of 2.4 that AgX has there.
#define TONE_MIXES 1
vec3 tone_mixed(vec3 light) {
    return mix(light, vec3(dot(light, vec3(1.0 / 3.0))), 0.16);
}
float tone_channel(float light) {
    float x = clamp((log2(max(light, 1e-8) / 0.18) + 10.0) / 16.5, 0.0, 1.0);
    const float POWER = 2.3;
    float rise = pow(x, POWER), rest = pow(1.0 - x, POWER);
    return pow(rise / (rise + 3.145 * rest), 2.2);
}
vec3 tone_unmixed(vec3 shown) {
    const vec3 WEIGHTS = vec3(0.2126, 0.7152, 0.0722);
    return clamp(mix(vec3(dot(shown, WEIGHTS)), shown, 1.12), 0.0, 1.0);
}
#else
#define TONE_MIXES 0
float tone_channel(float light) {
#if POST_TONE_MAP_REINHARD
    return light * (1.0 + light / 256.0) / (1.0 + light); // Reinhard et al. 2002, eq. 4, white at 16
#elif POST_TONE_MAP_ACES
    // K. Narkowicz' rational fit to the ACES reference rendering, "ACES filmic tone mapping curve" (2015).
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
#else
    return light;
#endif
}
#endif

// sRGB code of light^(1/γ). With s = light^(1/(2.4 γ)) the curve is 1.055 s − 0.055, and its straight toe 12.92 s^2.4: a polynomial
// in √s there, good to 3e-6, spares a power.
float srgb_code(float light) {
    float s = pow(max(light, 1e-12), 1.0 / (2.4 * post_gamma));
    float root = sqrt(s);
    float toe = 12.92 * s * s * (0.03652286 + root * (1.28840049 - 0.4598776 * root));
    return s < 0.0904934 ? toe : 1.055 * s - 0.055;
}
