// Light of which nothing but its colour is known, seen with `energy` times the energy that it has far away: its brightness goes as the fourth power, its colour as
// that of a black body of daylight's temperature.
#include "common/colour.glsl"

const float DAYLIGHT_KELVIN = 6500.0;

vec3 shifted_light(vec3 light, float energy) {
    float boost = energy * energy;
    return light * blackbody_colour(DAYLIGHT_KELVIN * energy) / blackbody_colour(DAYLIGHT_KELVIN) * (boost * boost);
}
