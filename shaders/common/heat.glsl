// Brightness, 0…1 → the screen's code of a colour from black over red, orange and yellow to white, in the manner of the map that the Event Horizon
// Telescope's pictures have. Each channel rises on a stretch of its own, red first and blue last; luminance rises all the way.
#if POST_COLOURS_AFMHOT
#include "common/luminance.glsl"

vec3 heat(float brightness) {
    float rest = 1.0 - clamp(brightness, 0.0, 1.0);
    float white = max(2.0 * brightness - 1.0, 0.0);
    return vec3(1.0 - rest * rest * rest, smoothstep(0.1, 0.95, brightness), min(white * white, 1.0));
}
#endif
