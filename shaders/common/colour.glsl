// Colour: linear Rec. 709 in, sRGB out, black bodies from a table.
//
// `blackbody_table` is assets/blackbody.npy (tools/make_blackbody.py), made eight times finer (blackhole_gl/blackbody.py): one row,
// 1,000…40,000 K evenly in log T, each entry of luminance 1. The nearest entry is within 0.1 % of the temperature.

uniform sampler2D blackbody_table;

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722); // ITU-R BT.709

// Linear Rec. 709 colour of a black body at `kelvin`, luminance 1. Outside the table: its nearest end.
vec3 blackbody_colour(float kelvin) {
    const float STEPS = 2047.0;
    float place = log2(max(kelvin, 1.0) * 1e-3) * (STEPS / 5.321928); // 5.32: log₂ of 40,000 K/1,000 K
    return texelFetch(blackbody_table, ivec2(int(clamp(place, 0.0, STEPS) + 0.5), 0), 0).rgb;
}
